// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/mesh/midside_nodes.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "smoothing/base/input_error.h"
#include "smoothing/mesh/volume_elements.h"

namespace smoothfem {

namespace {

/// A midside node, and one of its cells.
struct Placed {
  MidsidePlace place;
  NodeIndex node;
  CellIndex cell;

  auto by_place() const { return std::tie(place, cell); }
  auto by_node() const { return std::tie(node, cell); }
};

std::string place_name(const MidsidePlace& place) {
  const bool is_edge = place[2] == no_corner;
  return (is_edge ? "the edge between nodes " : "the face with nodes ") + std::to_string(place[0]) +
         " and " + std::to_string(is_edge ? place[1] : place[2]);
}

std::vector<Placed> placed_nodes(int dim, const CompressedRows<NodeIndex>& cells,
                                 const CompressedRows<NodeIndex>& midside) {
  std::vector<Placed> all;
  all.reserve(midside.n_entries());
  for (CellIndex c = 0; c < cells.size(); ++c)
    for_each_midside_place(dim, cells[c], midside[c],
                           [&](const MidsidePlace& place, NodeIndex node) {
                             all.push_back({place, node, c});
                           });
  return all;
}

/// Calls visit(places) for the corners' positions of each edge, then of each quadrilateral face of
/// a volume cell: the order of midside nodes.
template <class Visit>
void for_each_place(int dim, std::size_t n_corners, const Visit& visit) {
  for_each_edge(dim, n_corners, [&](std::size_t a, std::size_t b) {
    visit(std::vector<LocalIndex>{static_cast<LocalIndex>(a), static_cast<LocalIndex>(b)});
  });
  if (dim == 3)
    for_each_quadrilateral_face(n_corners, [&](const LocalFace& face) {
      visit(std::vector<LocalIndex>(face.nodes.begin(), face.nodes.end()));
    });
}

}  // namespace

std::vector<NodeIndex> reordered_midside(int dim, std::span<const NodeIndex> midside,
                                         std::span<const LocalIndex> corners) {
  std::vector<std::vector<LocalIndex>> old_places, new_places;
  for_each_place(dim, corners.size(), [&](std::vector<LocalIndex> place) {
    auto old = place;
    for (LocalIndex& corner : old) corner = corners[corner];
    std::sort(old.begin(), old.end());
    new_places.push_back(std::move(old));  // of the new place, in old positions
    std::sort(place.begin(), place.end());
    old_places.push_back(std::move(place));
  });
  std::vector<NodeIndex> result(midside.begin(), midside.end());  // the cell's node stays
  const MidsideCounts counts = midside_counts(dim, corners.size(), midside.size());
  const std::size_t n_placed = counts.edges + counts.faces;
  for (std::size_t k = 0; k < n_placed; ++k) {
    const auto old = std::find(old_places.begin(), old_places.end(), new_places[k]);
    result[k] = midside[static_cast<std::size_t>(old - old_places.begin())];
  }
  return result;
}

void check_midside_nodes(int dim, std::size_t n_nodes, const CompressedRows<NodeIndex>& cells,
                         const CompressedRows<NodeIndex>& midside) {
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
                               " as a midside node, but the node is a corner of a cell; "
                               "save all cells with one element order");
    }
  }
  auto placed = placed_nodes(dim, cells, midside);
  std::sort(placed.begin(), placed.end(),
            [](const Placed& a, const Placed& b) { return a.by_node() < b.by_node(); });
  for (std::size_t i = 1; i < placed.size(); ++i) {
    const Placed &a = placed[i - 1], &b = placed[i];
    if (a.node == b.node && a.place != b.place)
      throw CellError(b.cell, "has the midside node " + std::to_string(b.node) +
                                  ", which also belongs to another edge or face");
  }
  std::sort(placed.begin(), placed.end(),
            [](const Placed& a, const Placed& b) { return a.by_place() < b.by_place(); });
  for (std::size_t i = 1; i < placed.size(); ++i) {
    const Placed &a = placed[i - 1], &b = placed[i];
    if (a.place == b.place && a.node != b.node)
      throw CellError(b.cell, "has node " + std::to_string(b.node) + " on " + place_name(b.place) +
                                  ", where cell " + std::to_string(a.cell) + " has node " +
                                  std::to_string(a.node));
  }
}

}  // namespace smoothfem
