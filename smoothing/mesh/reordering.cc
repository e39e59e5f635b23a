// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/mesh/reordering.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "smoothing/base/parallel.h"

namespace smoothfem {

namespace {

/// Returns the nodes in the order of breadth-first searches from cell to cell, reversed. Each part
/// of the mesh starts from one of its boundary nodes, so that levels are small. This is the
/// algorithm of Cuthill and McKee, but the nodes of a level are not sorted by their neighbours:
/// that makes smoothing no faster.
std::vector<NodeIndex> nodes_by_level(const Topology& topology) {
  // A local table: the topology would keep its own, and these are large meshes.
  const auto node_cells = rows_by_entry(topology.cells(), topology.n_nodes());
  std::vector<std::uint8_t> reached(topology.n_nodes(), 0), passed(topology.n_cells(), 0);
  std::vector<NodeIndex> order(topology.n_nodes() + 1);
  std::size_t head = 0, tail = 0;
  const auto reach = [&](NodeIndex node) {  // no branch: its direction could not be predicted
    order[tail] = node;
    tail += 1u - reached[node];
    reached[node] = 1;
  };
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i) {
    if (topology.on_boundary()[i]) reach(i);
    for (; head < tail; ++head) {
      // The nodes that come next, and their cells, lie anywhere in memory. In a function of its own
      // this would do nothing: GCC drops calls without effect on results.
      if (head + 12 < tail) {
        const CellIndex* const cells = node_cells[order[head + 12]].data();
        __builtin_prefetch(cells);
        __builtin_prefetch(cells + 16);
      }
      if (head + 6 < tail)
        for (const CellIndex c : node_cells[order[head + 6]]) {
          __builtin_prefetch(&passed[c]);
          __builtin_prefetch(topology.cell_nodes(c).data());
        }
      for (const CellIndex c : node_cells[order[head]])
        if (!std::exchange(passed[c], 1))
          for (const NodeIndex j : topology.cell_nodes(c)) reach(j);
    }
  }
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i) reach(i);  // nodes that no cell uses
  order.pop_back();
  std::reverse(order.begin(), order.end());
  return order;
}

/// Orders cells by their first node in the new order. Cells of one type are kept together within a
/// few hundred nodes: whole vectors of cells of one type are cheaper than single cells.
std::vector<CellIndex> cells_by_first_node(const Topology& topology,
                                           const std::vector<NodeIndex>& node_order) {
  constexpr std::size_t group = 1024, grain = 4096;
  std::vector<NodeIndex> new_node(topology.n_nodes()), first(topology.n_cells());
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i) new_node[node_order[i]] = i;
  parallel_for_ranges(topology.n_cells(), grain, [&](std::size_t begin, std::size_t end) {
    for (auto c = static_cast<CellIndex>(begin); c < end; ++c) {
      first[c] = std::numeric_limits<NodeIndex>::max();
      for (const NodeIndex node : topology.cell_nodes(c))
        first[c] = std::min(first[c], new_node[node]);
    }
  });
  std::vector<std::size_t> offsets(topology.n_nodes() + 1, 0);
  for (const NodeIndex node : first) ++offsets[node + 1];
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  std::vector<CellIndex> order(topology.n_cells());
  auto next = offsets;
  for (CellIndex c = 0; c < topology.n_cells(); ++c) order[next[first[c]]++] = c;
  const auto n_nodes_of = [&](CellIndex c) { return topology.cell_nodes(c).size(); };
  CellIndex n_alike = 1;
  while (n_alike < topology.n_cells() && n_nodes_of(n_alike) == n_nodes_of(0)) ++n_alike;
  if (n_alike == topology.n_cells()) return order;
  const auto at_node = [&](std::size_t node) {
    return order.begin() + static_cast<std::ptrdiff_t>(offsets[std::min(node, topology.n_nodes())]);
  };
  parallel_for(topology.n_nodes() / group + 1, [&](std::size_t g) {
    std::stable_sort(at_node(g * group), at_node((g + 1) * group),
                     [&](CellIndex a, CellIndex b) { return n_nodes_of(a) < n_nodes_of(b); });
  });
  return order;
}

}  // namespace

template <int dim>
Reordering<dim>::Reordering(std::shared_ptr<const Topology> topology)
    : old_topology_(std::move(topology)),
      node_order_(nodes_by_level(*old_topology_)),
      topology_(old_topology_->reordered(node_order_,
                                         cells_by_first_node(*old_topology_, node_order_))) {}

template <int dim>
Mesh<dim> Reordering<dim>::apply(Mesh<dim> mesh) const {
  const auto old = std::move(mesh).take_coordinates();
  std::vector<Point<dim>> coordinates(old.size());
  for (std::size_t i = 0; i < old.size(); ++i) coordinates[i] = old[node_order_[i]];
  return Mesh<dim>::from_finite_points(topology_, std::move(coordinates));
}

template <int dim>
Mesh<dim> Reordering<dim>::undo(Mesh<dim> reordered) && noexcept {
  auto x = std::move(reordered).take_coordinates();
  // Follows the cycles of the permutation; visited entries are marked in the order itself.
  constexpr NodeIndex visited = std::numeric_limits<NodeIndex>::max();
  for (NodeIndex start = 0; start < x.size(); ++start) {
    Point<dim> carried = x[start];
    for (NodeIndex i = start; node_order_[i] != visited;) {
      const NodeIndex to = std::exchange(node_order_[i], visited);
      std::swap(carried, x[to]);
      i = to;
    }
  }
  return Mesh<dim>::from_finite_points(old_topology_, std::move(x));
}

template <int dim>
Mesh<dim> Reordering<dim>::restored(const Mesh<dim>& reordered) const {
  std::vector<Point<dim>> coordinates(reordered.n_nodes());
  restore(reordered.coordinates(), coordinates);
  return Mesh<dim>::from_finite_points(old_topology_, std::move(coordinates));
}

template <int dim>
void Reordering<dim>::restore(std::span<const Point<dim>> reordered,
                              std::span<Point<dim>> result) const {
  for (std::size_t i = 0; i < reordered.size(); ++i) result[node_order_[i]] = reordered[i];
}

template class Reordering<2>;
template class Reordering<3>;

}  // namespace smoothfem
