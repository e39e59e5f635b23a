// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "smoothing/loop/smoother.h"
#include "smoothing/mesh/node_constraints.h"

namespace smoothfem {

template <int dim, int spacedim>
Point<spacedim> mean_of_neighbours(const Mesh<dim, spacedim>& mesh, NodeIndex node) {
  const auto neighbours = mesh.topology().node_neighbours(node);
  Point<spacedim> sum = Point<spacedim>::Zero();
  for (const NodeIndex j : neighbours) sum += mesh.coordinates()[j];
  return sum / static_cast<double>(neighbours.size());
}

/// Moves each free node in node order by movement(node), as far as the mesh's constraints and the
/// bound of its facets allow. Later nodes see the new positions of earlier ones. Reports the
/// longest movement.
template <int dim, int spacedim, class Movement>
StepReport gauss_seidel_sweep(Mesh<dim, spacedim>& mesh, const Movement& movement) {
  double longest = 0.0;
  const auto sweep = [&](const auto& moved) {
    for (const NodeIndex i : mesh.topology().free_nodes()) {
      const Point<spacedim> move = moved(i, movement(i));
      longest = std::max(longest, squared_length<spacedim>(move));
    }
  };
  if (mesh.constraints() == nullptr)  // a loop of its own, which takes three quarters of the time
    sweep([&](NodeIndex i, const Point<spacedim>& move) {
      mesh.coordinates()[i] += move;
      return move;
    });
  else
    sweep([&](NodeIndex i, const Point<spacedim>& move) -> Point<spacedim> {
      const Point<spacedim> old = mesh.coordinates()[i];
      mesh.coordinates()[i] = allowed_position<dim, spacedim>(mesh, i, old + move);
      if (mesh.coordinates()[i] != old && !keeps_facet_bound(mesh, {&i, 1}))
        mesh.coordinates()[i] = old;
      return mesh.coordinates()[i] - old;
    });
  return {.max_displacement = std::sqrt(longest)};
}

/// Traits of Laplacian methods without quality control.
inline constexpr SmootherTraits uncontrolled_sweeps{.quality_use = QualityUse::none,
                                                    .result = ResultMesh::last,
                                                    .needs_valid_mesh = false,
                                                    .needs_node_order = true,
                                                    .keeps_constraints = true};

}  // namespace smoothfem
