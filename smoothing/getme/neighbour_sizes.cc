// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/getme/neighbour_sizes.h"

#include <cmath>

#include "smoothing/base/parallel.h"
#include "smoothing/transformations/scaling.h"

namespace smoothfem {

namespace {

constexpr std::size_t grain_of_sizes = 1024;  ///< nodes or cells that one thread takes at a time

Lanes absolute(Lanes values) {
  return values < 0.0 ? -values : values;
}

template <int dim, int spacedim>
double size_of(const Mesh<dim, spacedim>& mesh, CellIndex cell) {
  double size = 0.0;
  with_corners<dim>(mesh.topology().cell_nodes(cell), mesh.coordinates().data(),
                    [&](auto corners) { size = std::abs(node_simplex_size<dim>(corners)); });
  return size;
}

/// Returns the mean over the cells around a node. size(cell): the size of each.
template <class Size>
double mean_around(const Topology& topology, NodeIndex node, const Size& size) {
  const auto cells = topology.node_cells(node);
  double sum = 0.0;
  for (const CellIndex c : cells) sum += size(c);
  return cells.empty() ? 0.0 : sum / static_cast<double>(cells.size());
}

}  // namespace

template <int dim, int spacedim>
void NeighbourSizes<dim, spacedim>::update(const Mesh<dim, spacedim>& mesh) {
  const Topology& topology = mesh.topology();
  of_cell_.resize(topology.n_cells());
  at_node_.resize(topology.n_nodes());
  parallel_for_ranges(topology.n_cells(), grain_of_sizes, [&](std::size_t first, std::size_t last) {
    for_each_batch<dim, spacedim>(
        topology, static_cast<CellIndex>(first), static_cast<CellIndex>(last),
        [&]<std::size_t n>(const CellBatch<n>& batch) {
          const auto corners = batch.template corners<dim>(mesh.coordinates().data());
          batch.store(
              absolute(node_simplex_size<dim>(std::span<const Vector<dim, Lanes>, n>(corners))),
              of_cell_.data());
        },
        [&](CellIndex c) { of_cell_[c] = size_of(mesh, c); });
  });
  topology.build_node_cells();  // before several threads ask for it
  parallel_for_ranges(topology.n_nodes(), grain_of_sizes, [&](std::size_t first, std::size_t last) {
    for (auto i = static_cast<NodeIndex>(first); i < last; ++i)
      at_node_[i] = mean_around(topology, i, [&](CellIndex c) { return of_cell_[c]; });
  });
}

template <int dim, int spacedim>
void NeighbourSizes<dim, spacedim>::update(const Mesh<dim, spacedim>& mesh,
                                           std::span<const NodeIndex> nodes) {
  at_node_.resize(mesh.n_nodes());
  for (const NodeIndex i : nodes)
    at_node_[i] = mean_around(mesh.topology(), i, [&](CellIndex c) { return size_of(mesh, c); });
}

template class NeighbourSizes<2>;
template class NeighbourSizes<3>;
template class NeighbourSizes<2, 3>;

}  // namespace smoothfem
