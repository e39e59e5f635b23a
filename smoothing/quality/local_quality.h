#pragma once

#include <span>

#include "smoothing/quality/mean_ratio.h"
#include "smoothing/simd/cell_blocks.h"

namespace smoothfem {

/// Mean ratios of some cells, in their order: visit(position, quality) for each, false to stop.
/// Takes cells of one type several at a time where they follow each other. place_of(node): its
/// coordinates, by reference. Returns whether all were visited.
template <int dim, int spacedim, class PlaceOf, class Visit>
SMOOTHFEM_INLINE bool for_each_mean_ratio(const Mesh<dim, spacedim>& mesh,
                                          std::span<const CellIndex> cells, const PlaceOf& place_of,
                                          const Visit& visit) {
  return for_each_listed_run<dim, spacedim>(
      mesh.topology(), cells,
      [&]<std::size_t n>(std::integral_constant<std::size_t, n>, const ListedCells& listed)
          SMOOTHFEM_INLINE_LAMBDA {
            const auto corners = gather_cells<n, dim>(place_of, listed.rows);
            const Lanes quality = mean_ratio(std::span<const Vector<dim, Lanes>, n>(corners));
            bool going = true;
            for (std::size_t l = 0; l < listed.count && going; ++l)
              going = visit(listed.first + l, quality[l]);
            return going;
          },
      [&](std::size_t position) SMOOTHFEM_INLINE_LAMBDA {
        bool going = true;
        const CellIndex cell = cells[position];
        with_corners_at<dim>(mesh.topology().cell_nodes(cell), place_of, [&](auto corners) {
          going = visit(position, mean_ratio(upper_side(mesh, cell), corners));
        });
        return going;
      });
}

}  // namespace smoothfem
