#pragma once

#include <algorithm>
#include <cmath>

#include "smoothing/loop/smoother.h"
#include "smoothing/surface/node_constraints.h"

namespace smoothfem {

template <int dim, int spacedim>
Point<spacedim> mean_of_neighbours(const Mesh<dim, spacedim>& mesh, NodeIndex node) {
  const auto neighbours = mesh.topology().node_neighbours(node);
  Point<spacedim> sum = Point<spacedim>::Zero();
  for (const NodeIndex j : neighbours) sum += mesh.coordinates()[j];
  return sum / static_cast<double>(neighbours.size());
}

/// One sweep over the free nodes in node order, each moved at once by movement(node), as far as the
/// mesh's constraints and the bound of its facets let it, so that later nodes see the new places of
/// earlier ones. Reports the longest movement.
template <int dim, int spacedim, class Movement>
StepReport gauss_seidel_sweep(Mesh<dim, spacedim>& mesh, const Movement& movement) {
  double longest = 0.0;
  for (const NodeIndex i : mesh.topology().free_nodes()) {
    Point<spacedim> move = movement(i);
    const Point<spacedim> old = mesh.coordinates()[i];
    mesh.coordinates()[i] = allowed_place<dim, spacedim>(mesh, i, old + move);
    if (mesh.coordinates()[i] != old && !keeps_facet_bound(mesh, {&i, 1}))
      mesh.coordinates()[i] = old;
    if (mesh.constraints()) move = mesh.coordinates()[i] - old;
    longest = std::max(longest, move.squaredNorm());
  }
  return {.max_displacement = std::sqrt(longest)};
}

/// The stopping parameters of the Laplacian methods without quality control (thesis, 1.3.2): they
/// end when no node moves farther than a share of the mean edge length of the initial mesh.
struct DisplacementStopping {
  double tolerance = 0.01;  ///< the thesis' 1 %
  int max_iterations = 10000;

  Parameters parameters() {
    return {{"tolerance",
             "stop when the longest node movement falls below this share of the initial mean edge "
             "length (Section 1.3.2)",
             &tolerance, 0.0, 1e3},
            {"max_iterations", "stop after this many iterations at the latest", &max_iterations,
             1.0, 1e9}};
  }
  SmoothingRule rule() const {
    return {.quality_use = QualityUse::none,
            .needs_valid_mesh = false,
            .result = ResultMesh::last,
            .criterion = StoppingCriterion::max_displacement,
            .tolerance = tolerance,
            .max_iterations = max_iterations,
            .needs_node_order = true,
            .keeps_constraints = true};
  }
};

}  // namespace smoothfem
