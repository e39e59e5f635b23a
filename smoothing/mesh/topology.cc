#include "smoothing/mesh/topology.h"

#include <algorithm>
#include <string>
#include <tuple>

#include "smoothing/mesh/input_error.h"

namespace smoothfem {

namespace {

/// A cell's edge seen from its smaller node, so that the two cells of an edge meet when sorted.
struct CellEdge {
  NodeIndex lower, upper;
  CellIndex cell;
  std::uint32_t position;  ///< the edge leaves the cell's node at this position

  bool same_nodes(const CellEdge& other) const {
    return lower == other.lower && upper == other.upper;
  }
};

std::vector<CellEdge> sorted_edges(const CompressedRows<NodeIndex>& cells) {
  std::vector<CellEdge> edges;
  edges.reserve(cells.n_entries());
  for (CellIndex c = 0; c < cells.size(); ++c) {
    const auto nodes = cells[c];
    for (std::uint32_t k = 0; k < nodes.size(); ++k) {
      const auto [lower, upper] = std::minmax(nodes[k], nodes[(k + 1) % nodes.size()]);
      edges.push_back({lower, upper, c, k});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const CellEdge& a, const CellEdge& b) {
    return std::tie(a.lower, a.upper, a.cell) < std::tie(b.lower, b.upper, b.cell);
  });
  return edges;
}

/// Rows of values by key: row k holds the values of all pairs (k, value), in the order of the
/// pairs.
template <class T>
CompressedRows<T> group_by_key(std::size_t n_rows,
                               const std::vector<std::pair<NodeIndex, T>>& pairs) {
  std::vector<std::size_t> offsets(n_rows + 1, 0);
  for (const auto& [key, value] : pairs) ++offsets[key + 1];
  for (std::size_t i = 0; i < n_rows; ++i) offsets[i + 1] += offsets[i];
  std::vector<T> entries(pairs.size());
  auto next = offsets;
  for (const auto& [key, value] : pairs) entries[next[key]++] = value;
  return {std::move(offsets), std::move(entries)};
}

}  // namespace

Topology::Topology(std::size_t n_nodes, CompressedRows<NodeIndex> cells,
                   std::optional<std::vector<bool>> fixed, MeshLabels labels)
    : cells_(std::move(cells)), labels_(std::move(labels)) {
  check_cells(n_nodes);
  build_node_cells(n_nodes);
  build_edges(n_nodes);
  build_fixed(fixed);
}

void Topology::check_cells(std::size_t n_nodes) const {
  if (cells_.empty()) throw InputError("the mesh has no cells");
  std::vector<NodeIndex> sorted;
  for (CellIndex c = 0; c < cells_.size(); ++c) {
    const auto nodes = cells_[c];
    if (nodes.size() < 3)
      throw CellError(
          c, "has " + std::to_string(nodes.size()) + " nodes; a planar cell needs at least three");
    sorted.assign(nodes.begin(), nodes.end());
    std::sort(sorted.begin(), sorted.end());
    if (sorted.back() >= n_nodes)
      throw CellError(c, "names node " + std::to_string(sorted.back()) +
                             ", but the mesh has only " + std::to_string(n_nodes) +
                             " nodes, counted from 0");
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end())
      throw CellError(c, "names node " + std::to_string(*twice) + " more than once");
  }
}

void Topology::build_node_cells(std::size_t n_nodes) {
  std::vector<std::pair<NodeIndex, CellIndex>> pairs;
  pairs.reserve(cells_.n_entries());
  for (CellIndex c = 0; c < cells_.size(); ++c)
    for (const NodeIndex node : cells_[c]) pairs.emplace_back(node, c);
  node_cells_ = group_by_key(n_nodes, pairs);
}

void Topology::build_edges(std::size_t n_nodes) {
  const auto edges = sorted_edges(cells_);
  std::vector<std::pair<NodeIndex, NodeIndex>> neighbours;
  std::vector<CellEdge> boundary;
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t last = first + 1;
    while (last < edges.size() && edges[last].same_nodes(edges[first])) ++last;
    const auto& edge = edges[first];
    if (last - first > 2)
      throw CellError(edges[last - 1].cell,
                      "is cell number " + std::to_string(last - first) +
                          " at the edge between nodes " + std::to_string(edge.lower) + " and " +
                          std::to_string(edge.upper) + "; at most two planar cells share an edge");
    if (last - first == 1) boundary.push_back(edge);
    neighbours.emplace_back(edge.lower, edge.upper);
    ++n_edges_;
    first = last;
  }
  const std::size_t n_half = neighbours.size();
  for (std::size_t e = 0; e < n_half; ++e)
    neighbours.emplace_back(neighbours[e].second, neighbours[e].first);
  std::sort(neighbours.begin(), neighbours.end());
  node_neighbours_ = group_by_key(n_nodes, neighbours);

  std::sort(boundary.begin(), boundary.end(), [](const CellEdge& a, const CellEdge& b) {
    return std::tie(a.cell, a.position) < std::tie(b.cell, b.position);
  });
  on_boundary_.assign(n_nodes, false);
  for (const auto& edge : boundary) {
    const auto nodes = cells_[edge.cell];
    boundary_edges_.emplace_back(nodes[edge.position], nodes[(edge.position + 1) % nodes.size()]);
    on_boundary_[edge.lower] = on_boundary_[edge.upper] = true;
  }
}

void Topology::build_fixed(const std::optional<std::vector<bool>>& fixed) {
  const std::size_t n = n_nodes();
  if (fixed && fixed->size() != n)
    throw InputError("the mesh has " + std::to_string(n) + " nodes but " +
                     std::to_string(fixed->size()) + " fixed flags");
  const auto& flags = fixed ? *fixed : on_boundary_;
  fixed_.resize(n);
  for (NodeIndex i = 0; i < n; ++i) {
    fixed_[i] = flags[i] || node_cells_[i].empty();
    if (!fixed_[i]) free_nodes_.push_back(i);
  }
  cell_has_free_node_.resize(n_cells());
  for (CellIndex c = 0; c < n_cells(); ++c) {
    const auto nodes = cells_[c];
    cell_has_free_node_[c] =
        std::any_of(nodes.begin(), nodes.end(), [&](NodeIndex i) { return !fixed_[i]; });
  }
}

}  // namespace smoothfem
