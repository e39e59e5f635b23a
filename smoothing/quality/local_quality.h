// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <type_traits>

#include "smoothing/quality/mean_ratio.h"
#include "smoothing/quality/target_corners.h"

namespace smoothfem {

/// Computes the mean ratios of some cells in their order. Calls visit(position, quality) for each;
/// it returns false to stop. Takes consecutive cells of one type several at a time.
/// coordinates_of(node): by reference. Returns true if all cells were visited.
template <int dim, int spacedim, class CoordinatesOf, class Visit>
bool for_each_mean_ratio_at(const Mesh<dim, spacedim>& mesh, std::span<const CellIndex> cells,
                            const CoordinatesOf& coordinates_of, const Visit& visit) {
  const auto for_each = [&](auto has_targets) {
    const CellTargets<dim>* const targets = has_targets ? mesh.targets() : nullptr;
    return for_each_batch<dim, spacedim>(
        ListedCells(mesh.topology(), cells),
        [&]<std::size_t n>(const CellBatch<n>& batch) {
          const auto corners = target_corners<dim>(targets, batch, coordinates_of);
          const std::span<const Vector<dim, Lanes>, n> nodes(corners);
          const Lanes quality = within_size_bound<dim>(targets, nodes, mean_ratio(nodes));
          bool keep_going = true;
          for (std::size_t l = 0; l < batch.count && keep_going; ++l)
            keep_going = visit(batch.first + l, quality[l]);
          return keep_going;
        },
        [&](std::size_t position) {
          bool keep_going = true;
          const CellIndex cell = cells[position];
          with_target_corners(mesh, cell, coordinates_of, [&](auto corners) {
            keep_going = visit(position, target_mean_ratio(mesh, cell, corners));
          });
          return keep_going;
        });
  };
  // Without targets, the code for them would keep corners out of registers.
  return mesh.targets() == nullptr ? for_each(std::false_type{}) : for_each(std::true_type{});
}

/// Does the same with the nodes at the mesh's coordinates.
template <int dim, int spacedim, class Visit>
bool for_each_mean_ratio(const Mesh<dim, spacedim>& mesh, std::span<const CellIndex> cells,
                         const Visit& visit) {
  const Point<spacedim>* const x = mesh.coordinates().data();
  return for_each_mean_ratio_at(mesh, cells, coordinates_at(x), visit);
}

}  // namespace smoothfem
