// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "smoothing/base/parallel.h"
#include "smoothing/loop/smoother.h"
#include "smoothing/mesh/node_constraints.h"
#include "smoothing/parts/shared_coordinates.h"

namespace smoothfem {

template <int dim, int spacedim>
Point<spacedim> mean_of_neighbours(const Mesh<dim, spacedim>& mesh, NodeIndex node) {
  const auto neighbours = mesh.topology().node_neighbours(node);
  Point<spacedim> sum = Point<spacedim>::Zero();
  for (const NodeIndex j : neighbours) sum += mesh.coordinates()[j];
  return sum / static_cast<double>(neighbours.size());
}

/// Moves all free nodes of a part of a mesh at once: movement(position, node) sees the old
/// positions of all. A sweep in node order would depend on the parts. Reports the longest movement
/// in the whole mesh. Collective.
template <int dim, int spacedim, class Movement>
StepReport jacobi_sweep(Mesh<dim, spacedim>& mesh, const Movement& movement) {
  constexpr std::size_t grain = 1024;
  const auto& nodes = mesh.topology().free_nodes();
  std::vector<Point<spacedim>> moves(nodes.size());
  parallel_for_ranges(nodes.size(), grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) moves[k] = movement(k, nodes[k]);
  });
  double longest = 0.0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    mesh.coordinates()[nodes[k]] += moves[k];
    longest = std::max(longest, squared_length<spacedim>(moves[k]));
  }
  update_copies(mesh);
  return {.max_displacement = mesh.topology().part()->max(std::sqrt(longest))};
}

/// Moves each free node in node order by movement(position, node), as far as the mesh's constraints
/// and the bound of its facets allow. position: the node's among the free ones. Later nodes see the
/// new positions of earlier ones. Reports the longest movement. In parts of a mesh, nodes move at
/// once.
template <int dim, int spacedim, class Movement>
StepReport laplacian_sweep(Mesh<dim, spacedim>& mesh, const Movement& movement) {
  if (mesh.topology().part()) return jacobi_sweep(mesh, movement);
  double longest = 0.0;
  const auto sweep = [&](const auto& moved) {
    std::size_t position = 0;
    for (const NodeIndex i : mesh.topology().free_nodes()) {
      const Point<spacedim> move = moved(i, movement(position++, i));
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
                                                    .keeps_constraints = true,
                                                    .works_in_parts = true};

}  // namespace smoothfem
