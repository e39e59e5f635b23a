#pragma once

#include <array>
#include <span>
#include <vector>

#include "smoothing/getme/element_regularization.h"
#include "smoothing/getme/node_sums.h"
#include "smoothing/simd/cell_blocks.h"

namespace smoothfem {

/// transformed where `transforms` says so, otherwise original. All: every cell is transformed.
struct AllTransformed {};
template <class Point>
SMOOTHFEM_INLINE Point chosen(AllTransformed, Point transformed, Point /*original*/) {
  return transformed;
}
template <class Point>
SMOOTHFEM_INLINE Point chosen(bool transforms, Point transformed, Point original) {
  return transforms ? transformed : original;
}
SMOOTHFEM_INLINE Vector2<Lanes> chosen(LaneMask transforms, Vector2<Lanes> transformed,
                                       Vector2<Lanes> original) {
  return {transforms ? transformed.x : original.x, transforms ? transformed.y : original.y};
}
SMOOTHFEM_INLINE Vector3<Lanes> chosen(LaneMask transforms, Vector3<Lanes> transformed,
                                       Vector3<Lanes> original) {
  return {transforms ? transformed.x : original.x, transforms ? transformed.y : original.y,
          transforms ? transformed.z : original.z};
}

/// What adding transformed elements to the sums of their nodes needs to know. Weighting says how
/// much a cell counts: weight(cell, quality), for one cell or for n_lanes of them (an array of
/// indices, Lanes), and which cells are transformed at all: transforms(quality), likewise; the
/// others add their nodes as they are.
template <int dim, class Weighting, int spacedim = dim>
struct ElementPass {
  const Mesh<dim, spacedim>& mesh;
  const ElementRegularization<dim, spacedim>& element;
  Weighting weighting;
};

/// Adds the transformed nodes of n_lanes cells of n nodes each to the sums of a block, those of the
/// first `count` cells, where wanted(node). Returns the cells' quality.
template <std::size_t n, int dim, class Weighting, class Wanted>
SMOOTHFEM_INLINE Lanes add_cells(const ElementPass<dim, Weighting>& pass,
                                 const std::array<CellIndex, n_lanes>& cells,
                                 const std::array<const NodeIndex*, n_lanes>& rows,
                                 std::size_t count, const Wanted& wanted, double* sums) {
  const auto& x = pass.mesh.coordinates();
  const auto corners = gather_cells<n, dim>(
      [&](NodeIndex i) SMOOTHFEM_INLINE_LAMBDA -> const Point<dim>& { return x[i]; }, rows);
  std::array<Vector<dim, Lanes>, n> result;
  const Lanes quality = pass.element.regularize(std::span<const Vector<dim, Lanes>, n>(corners),
                                                std::span<Vector<dim, Lanes>, n>(result));
  const Lanes weight = pass.weighting.weight(cells, quality);
  const auto transforms = pass.weighting.transforms(quality);
  unrolled<n>([&](auto k) SMOOTHFEM_INLINE_LAMBDA {
    const auto places = weighted_places(chosen(transforms, result[k], corners[k]), weight);
    for (std::size_t l = 0; l < count; ++l)
      if (wanted(rows[l][k])) NodeSums::add(sums, rows[l][k], places[l]);
  });
  return quality;
}

/// The same for one cell of any type.
template <int dim, class Weighting, int spacedim, class Wanted>
SMOOTHFEM_INLINE double add_cell(const ElementPass<dim, Weighting, spacedim>& pass, CellIndex cell,
                                 const Wanted& wanted, double* sums) {
  const auto nodes = pass.mesh.topology().cell_nodes(cell);
  double quality = 0.0;
  with_corners<dim>(nodes, pass.mesh.coordinates(), [&](auto corners) SMOOTHFEM_INLINE_LAMBDA {
    with_room_for_result(corners, [&](auto result) SMOOTHFEM_INLINE_LAMBDA {
      quality = regularize(pass.element, upper_side(pass.mesh, cell), corners, result);
      const double weight = pass.weighting.weight(cell, quality);
      const auto transforms = pass.weighting.transforms(quality);
      for (std::size_t k = 0; k < result.size(); ++k)
        if (wanted(nodes[k]))
          NodeSums::add(sums, nodes[k],
                        weighted_place(chosen(transforms, result[k], corners[k]), weight));
    });
  });
  return quality;
}

/// Adds all cells of a block in their order and writes their quality.
template <int dim, class Weighting, int spacedim>
SMOOTHFEM_INLINE void add_whole_block(const ElementPass<dim, Weighting, spacedim>& pass,
                                      const CellBlock& block, double* cell_quality, double* sums) {
  const auto all = [](NodeIndex) SMOOTHFEM_INLINE_LAMBDA { return true; };
  for_each_run<dim, spacedim>(
      pass.mesh.topology(), block.first, block.last,
      [&]<std::size_t n>(std::integral_constant<std::size_t, n>, CellIndex c,
                         const NodeIndex* nodes) SMOOTHFEM_INLINE_LAMBDA {
        const Lanes quality =
            add_cells<n, dim>(pass, {c, c + 1, c + 2, c + 3},
                              {nodes, nodes + n, nodes + 2 * n, nodes + 3 * n}, n_lanes, all, sums);
        store_lanes(quality, cell_quality + c);
      },
      [&](CellIndex c) SMOOTHFEM_INLINE_LAMBDA { cell_quality[c] = add_cell(pass, c, all, sums); });
}

/// Adds some cells of a block, ascending, to the sums of marked nodes only. Their qualities are
/// known.
template <int dim, class Weighting, int spacedim>
SMOOTHFEM_INLINE void add_to_marked(const ElementPass<dim, Weighting, spacedim>& pass,
                                    std::span<const CellIndex> cells,
                                    const std::vector<std::uint8_t>& marked, double* sums) {
  const auto wanted = [&](NodeIndex i) SMOOTHFEM_INLINE_LAMBDA { return marked[i] != 0; };
  for_each_listed_run<dim, spacedim>(
      pass.mesh.topology(), cells,
      [&]<std::size_t n>(std::integral_constant<std::size_t, n>, const ListedCells& listed)
          SMOOTHFEM_INLINE_LAMBDA {
            // One cell after the other to a node: the sums keep the order of the cells.
            add_cells<n, dim>(pass, listed.cells, listed.rows, listed.count, wanted, sums);
            return true;
          },
      [&](std::size_t position) SMOOTHFEM_INLINE_LAMBDA {
        add_cell(pass, cells[position], wanted, sums);
        return true;
      });
}

}  // namespace smoothfem
