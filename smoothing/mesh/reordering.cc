// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/mesh/reordering.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "smoothing/base/parallel.h"

namespace smoothfem {

namespace {

/// Breadth-first search over the nodes of a mesh, from cell to cell: nodes of one cell are
/// neighbours. A table of neighbours would take longer to make than both searches.
class BreadthFirst {
 public:
  BreadthFirst(const Topology& topology, const CompressedRows<CellIndex>& node_cells)
      : topology_(topology),
        node_cells_(node_cells),
        visited_(topology.n_nodes(), 0),
        expanded_(topology.n_cells(), 0) {}

  bool has_visited(NodeIndex node) const { return visited_[node] != 0; }

  /// Appends what can be reached from a node to `order`, those with few cells first among the nodes
  /// that are reached from the same one.
  void append_from(NodeIndex start, std::vector<NodeIndex>& order) {
    std::size_t head = order.size();
    order.push_back(start);
    visited_[start] = 1;
    for (; head < order.size(); ++head) {
      const auto n_before = static_cast<std::ptrdiff_t>(order.size());
      for (const CellIndex c : node_cells_[order[head]]) {
        if (std::exchange(expanded_[c], 1)) continue;
        for (const NodeIndex j : topology_.cell_nodes(c))
          if (!std::exchange(visited_[j], 1)) order.push_back(j);
      }
      std::sort(order.begin() + n_before, order.end(), [&](NodeIndex a, NodeIndex b) {
        return std::make_pair(node_cells_[a].size(), a) < std::make_pair(node_cells_[b].size(), b);
      });
    }
  }

 private:
  const Topology& topology_;
  const CompressedRows<CellIndex>& node_cells_;
  std::vector<std::uint8_t> visited_, expanded_;
};

/// Each part of the mesh starts at a node that a search from its lowest node finds last: far out,
/// so that levels are small.
std::vector<NodeIndex> reverse_cuthill_mckee(const Topology& topology) {
  // The topology's own table would be kept, but these are large meshes.
  const auto node_cells = rows_by_entry(topology.cells(), topology.n_nodes());
  BreadthFirst search(topology, node_cells), numbering(topology, node_cells);
  std::vector<NodeIndex> found, order;
  order.reserve(topology.n_nodes());
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i) {
    if (numbering.has_visited(i)) continue;
    found.clear();
    search.append_from(i, found);
    numbering.append_from(found.back(), order);
  }
  std::reverse(order.begin(), order.end());
  return order;
}

/// Cells by their first node in the new order, cells of one size together within some hundred
/// nodes: whole vectors of cells of one type are cheaper than single ones.
std::vector<CellIndex> cells_by_first_node(const Topology& topology,
                                           const std::vector<NodeIndex>& node_order) {
  constexpr NodeIndex group = 1024;
  std::vector<NodeIndex> new_node(topology.n_nodes());
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i) new_node[node_order[i]] = i;
  std::vector<NodeIndex> first(topology.n_cells(), std::numeric_limits<NodeIndex>::max());
  for (CellIndex c = 0; c < topology.n_cells(); ++c)
    for (const NodeIndex node : topology.cell_nodes(c))
      first[c] = std::min(first[c], new_node[node]);
  std::vector<CellIndex> order(topology.n_cells());
  std::iota(order.begin(), order.end(), CellIndex{0});
  const auto key = [&](CellIndex c) {
    return std::make_tuple(first[c] / group, topology.cell_nodes(c).size(), first[c], c);
  };
  // Sorted by groups of nodes first, which is cheap, then each group on its own.
  std::vector<std::size_t> offsets(topology.n_nodes() / group + 2, 0);
  for (const NodeIndex node : first) ++offsets[node / group + 1];
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  auto next = offsets;
  for (CellIndex c = 0; c < topology.n_cells(); ++c) order[next[first[c] / group]++] = c;
  parallel_for(offsets.size() - 1, [&](std::size_t g) {
    std::sort(order.begin() + offsets[g], order.begin() + offsets[g + 1],
              [&](CellIndex a, CellIndex b) { return key(a) < key(b); });
  });
  return order;
}

}  // namespace

template <int dim>
Reordering<dim>::Reordering(std::shared_ptr<const Topology> topology)
    : old_topology_(std::move(topology)),
      node_order_(reverse_cuthill_mckee(*old_topology_)),
      topology_(old_topology_->reordered(node_order_,
                                         cells_by_first_node(*old_topology_, node_order_))) {}

template <int dim>
Mesh<dim> Reordering<dim>::apply(Mesh<dim> mesh) const {
  const auto old = std::move(mesh).take_coordinates();
  std::vector<Point<dim>> coordinates(old.size());
  for (std::size_t i = 0; i < old.size(); ++i) coordinates[i] = old[node_order_[i]];
  return Mesh<dim>::of_known_points(topology_, std::move(coordinates));
}

template <int dim>
Mesh<dim> Reordering<dim>::undo(Mesh<dim> reordered) && noexcept {
  auto x = std::move(reordered).take_coordinates();
  // Along the cycles of the permutation; what has been visited is marked in the order itself.
  constexpr NodeIndex visited = std::numeric_limits<NodeIndex>::max();
  for (NodeIndex start = 0; start < x.size(); ++start) {
    Point<dim> carried = x[start];
    for (NodeIndex i = start; node_order_[i] != visited;) {
      const NodeIndex to = std::exchange(node_order_[i], visited);
      std::swap(carried, x[to]);
      i = to;
    }
  }
  return Mesh<dim>::of_known_points(old_topology_, std::move(x));
}

template <int dim>
Mesh<dim> Reordering<dim>::restored(const Mesh<dim>& reordered) const {
  std::vector<Point<dim>> coordinates(reordered.n_nodes());
  restore(reordered.coordinates(), coordinates);
  return Mesh<dim>::of_known_points(old_topology_, std::move(coordinates));
}

template <int dim>
void Reordering<dim>::restore(std::span<const Point<dim>> reordered,
                              std::span<Point<dim>> result) const {
  for (std::size_t i = 0; i < reordered.size(); ++i) result[node_order_[i]] = reordered[i];
}

template class Reordering<2>;
template class Reordering<3>;

}  // namespace smoothfem
