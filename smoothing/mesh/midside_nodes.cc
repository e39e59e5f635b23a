// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/mesh/midside_nodes.h"

#include <algorithm>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "smoothing/base/input_error.h"
#include "smoothing/mesh/volume_elements.h"

namespace smoothfem {

namespace {

/// A midside node, the corners of its edge or face, sorted, and one of its cells.
struct Placed {
  std::array<NodeIndex, 4> corners;
  NodeIndex node;
  CellIndex cell;

  auto by_corners() const { return std::tie(corners, cell); }
  auto by_node() const { return std::tie(node, cell); }
};

std::string place_name(const std::array<NodeIndex, 4>& corners) {
  constexpr NodeIndex none = std::numeric_limits<NodeIndex>::max();
  const bool is_edge = corners[2] == none;
  return (is_edge ? "the edge between nodes " : "the face with nodes ") +
         std::to_string(corners[0]) + " and " + std::to_string(is_edge ? corners[1] : corners[2]);
}

/// Collects the nodes of edges and faces. The node in a cell's middle belongs to no other cell.
std::vector<Placed> placed_nodes(int dim, const CompressedRows<NodeIndex>& cells,
                                 const CompressedRows<NodeIndex>& midside) {
  constexpr NodeIndex none = std::numeric_limits<NodeIndex>::max();
  std::vector<Placed> all;
  all.reserve(midside.n_entries());
  for (CellIndex c = 0; c < cells.size(); ++c) {
    const auto corners = cells[c], nodes = midside[c];
    if (nodes.empty()) continue;
    const auto counts = midside_counts(dim, corners.size(), nodes.size());
    std::size_t next = 0;
    for_each_edge(dim, corners.size(), [&](std::size_t a, std::size_t b) {
      const auto [low, high] = std::minmax(corners[a], corners[b]);
      all.push_back({{low, high, none, none}, nodes[next++], c});
    });
    if (counts.faces > 0)
      for_each_quadrilateral_face(corners.size(), [&](const LocalFace& face) {
        std::array<NodeIndex, 4> of_face{};
        for (std::size_t k = 0; k < 4; ++k) of_face[k] = corners[face.nodes[k]];
        std::sort(of_face.begin(), of_face.end());
        all.push_back({of_face, nodes[next++], c});
      });
    if (counts.cell > 0) all.push_back({{none, none, none, none}, nodes[next], c});
  }
  return all;
}

}  // namespace

void check_midside_nodes(int dim, std::size_t n_nodes, const CompressedRows<NodeIndex>& cells,
                         const CompressedRows<NodeIndex>& midside) {
  constexpr NodeIndex none = std::numeric_limits<NodeIndex>::max();
  std::vector<bool> is_corner(n_nodes, false);
  for (const NodeIndex node : cells.entries()) is_corner[node] = true;
  for (CellIndex c = 0; c < cells.size(); ++c) {
    const auto nodes = midside[c];
    if (!nodes.empty() && midside_counts(dim, cells[c].size(), nodes.size()).sum() == 0)
      throw CellError(c, "has " + std::to_string(cells[c].size()) + " corners and " +
                             std::to_string(nodes.size()) +
                             " midside nodes; there is no such element of second order");
    for (const NodeIndex node : nodes) {
      if (node >= n_nodes)
        throw CellError(c, "names node " + std::to_string(node) + ", but the mesh has only " +
                               std::to_string(n_nodes) + " nodes, counted from 0");
      if (is_corner[node])
        throw CellError(c, "has node " + std::to_string(node) +
                               " as a midside node, but the node is a corner of a cell");
    }
  }
  auto placed = placed_nodes(dim, cells, midside);
  std::sort(placed.begin(), placed.end(),
            [](const Placed& a, const Placed& b) { return a.by_node() < b.by_node(); });
  for (std::size_t i = 1; i < placed.size(); ++i) {
    const Placed &a = placed[i - 1], &b = placed[i];
    if (a.node == b.node && (a.corners != b.corners || b.corners[0] == none))
      throw CellError(b.cell, "has the midside node " + std::to_string(b.node) +
                                  ", which also belongs to another edge or face");
  }
  std::sort(placed.begin(), placed.end(),
            [](const Placed& a, const Placed& b) { return a.by_corners() < b.by_corners(); });
  for (std::size_t i = 1; i < placed.size(); ++i) {
    const Placed &a = placed[i - 1], &b = placed[i];
    if (a.corners == b.corners && b.corners[0] != none && a.node != b.node)
      throw CellError(b.cell, "has node " + std::to_string(b.node) + " on " +
                                  place_name(b.corners) + ", where cell " + std::to_string(a.cell) +
                                  " has node " + std::to_string(a.node));
  }
}

}  // namespace smoothfem
