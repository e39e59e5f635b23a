// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/mesh/midside_nodes.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
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

  bool operator<(const Placed& other) const {
    return std::tie(place, cell) < std::tie(other.place, other.cell);
  }
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

}  // namespace

std::vector<NodeIndex> reordered_midside(int dim, std::span<const NodeIndex> midside,
                                         std::span<const LocalIndex> corners) {
  std::vector<NodeIndex> old_corners(corners.size()), positions(midside.size());
  std::iota(old_corners.begin(), old_corners.end(), NodeIndex{0});
  std::iota(positions.begin(), positions.end(), NodeIndex{0});
  std::map<MidsidePlace, NodeIndex> nodes;
  for_each_midside_place(dim, old_corners, midside, [&](const MidsidePlace& place, NodeIndex node) {
    nodes.emplace(place, node);
  });
  const std::vector<NodeIndex> new_corners(corners.begin(), corners.end());
  std::vector<NodeIndex> result(midside.begin(), midside.end());
  for_each_midside_place(dim, new_corners, positions,
                         [&](const MidsidePlace& place, NodeIndex position) {
                           // The cell's own node stays.
                           if (const auto found = nodes.find(place); found != nodes.end())
                             result[position] = found->second;
                         });
  return result;
}

CompressedRows<NodeIndex> midside_of_facets(int dim, const CompressedRows<NodeIndex>& cells,
                                            const CompressedRows<NodeIndex>& midside,
                                            const CompressedRows<NodeIndex>& facets) {
  const auto place_of = [](std::span<const NodeIndex> corners) {
    MidsidePlace place{no_corner, no_corner, no_corner, no_corner};
    std::copy(corners.begin(), corners.end(), place.begin());
    std::sort(place.begin(), place.end());
    return place;
  };
  const auto side_of = [&](std::span<const NodeIndex> corners, std::size_t k) {
    return place_of(std::array{corners[k], corners[(k + 1) % corners.size()]});
  };
  std::map<MidsidePlace, NodeIndex> nodes;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    nodes.emplace(place_of(facets[f]), no_corner);
    for (std::size_t k = 0; k < facets[f].size(); ++k)
      nodes.emplace(side_of(facets[f], k), no_corner);
  }
  for (CellIndex c = 0; c < cells.size(); ++c)
    for_each_midside_place(dim, cells[c], midside[c],
                           [&](const MidsidePlace& place, NodeIndex node) {
                             if (const auto found = nodes.find(place); found != nodes.end())
                               found->second = node;
                           });
  CompressedRows<NodeIndex> rows;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    std::vector<NodeIndex> row;
    for (std::size_t k = 0; k < (dim == 2 ? 1 : facets[f].size()); ++k)
      row.push_back(nodes.at(side_of(facets[f], k)));
    if (dim == 3)
      if (const NodeIndex middle = nodes.at(place_of(facets[f])); middle != no_corner)
        row.push_back(middle);
    rows.append(row);
  }
  return rows;
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
  constexpr MidsidePlace unknown{no_corner, no_corner, no_corner, no_corner};
  std::vector<MidsidePlace> place_of(n_nodes, unknown);
  for (const Placed& p : placed) {
    if (place_of[p.node] != unknown && place_of[p.node] != p.place)
      throw CellError(p.cell, "has the midside node " + std::to_string(p.node) +
                                  ", which also belongs to another edge or face");
    place_of[p.node] = p.place;
  }
  std::sort(placed.begin(), placed.end());
  for (std::size_t i = 1; i < placed.size(); ++i) {
    const Placed &a = placed[i - 1], &b = placed[i];
    if (a.place == b.place && a.node != b.node)
      throw CellError(b.cell, "has node " + std::to_string(b.node) + " on " + place_name(b.place) +
                                  ", where cell " + std::to_string(a.cell) + " has node " +
                                  std::to_string(a.node));
  }
}

}  // namespace smoothfem
