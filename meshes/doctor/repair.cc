// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/doctor/repair.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "meshes/doctor/examinations/orientation.h"
#include "meshes/doctor/examinations/same_cells.h"
#include "meshes/doctor/examinations/seams.h"
#include "meshes/doctor/examine.h"
#include "smoothing/mesh/sorted_nodes.h"

namespace smoothfem {

namespace {

PlainCells cells_of(const MeshParts& parts) {
  const int dim = dimension_of(parts);
  return {dim, parts.elements[dim].nodes, parts.coordinates, dim == 2 && is_planar(parts)};
}

/// True if the tables of the doctor can be made; Topology refuses other cells with a sentence.
bool has_possible_cells(const MeshParts& parts) {
  const auto [dim, cells, points, planar] = cells_of(parts);
  if (cells.empty() || points.size() >= no_node) return false;
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (!is_cell_size(dim, cells[c].size())) return false;
  const auto& nodes = cells.entries();
  return *std::max_element(nodes.begin(), nodes.end()) < points.size();
}

std::string cell_text(const MeshParts& parts, CellIndex cell) {
  const ElementList& list = parts.elements[dimension_of(parts)];
  const std::size_t number = list.ids.empty() || list.ids[cell] == 0 ? cell : list.ids[cell];
  std::string text = "cell " + std::to_string(number);
  if (!list.lines.empty()) text += " (line " + std::to_string(list.lines[cell]) + ")";
  return text + " at " + place_text(parts.coordinates[list.nodes[cell][0]], cells_of(parts).planar);
}

/// Returns the midside nodes of cells some of which are turned over.
CompressedRows<NodeIndex> turned_midside(int dim, const ElementList& list,
                                         std::span<const CellIndex> reversed) {
  CompressedRows<NodeIndex> result;
  for (CellIndex c = 0; c < list.midside.size(); ++c) {
    if (std::binary_search(reversed.begin(), reversed.end(), c))
      result.append(
          reordered_midside(dim, list.midside[c], reversed_corners(dim, list.nodes[c].size())));
    else
      result.append(list.midside[c]);
  }
  return result;
}

void turn_over(MeshParts& parts, std::vector<std::string>& done) {
  const PlainCells cells = cells_of(parts);
  const auto reversed = find_reversed_cells(cells).reversed;
  if (reversed.empty()) return;
  const bool one = reversed.size() == 1;
  done.push_back("turned over " + std::to_string(reversed.size()) + " of " +
                 std::to_string(cells.cells.size()) + " cells, because " +
                 (one ? "it lists its" : "they list their") + " nodes in the wrong direction: " +
                 (one ? "" : "the first is ") + cell_text(parts, reversed.front()));
  auto turned = with_reversed(cells.dim, cells.cells, reversed);
  ElementList& list = parts.elements[cells.dim];
  if (!list.midside.empty()) list.midside = turned_midside(cells.dim, list, reversed);
  list.nodes = std::move(turned);
}

/// Removes the elements with these indices (ascending) from a list.
void remove_elements(ElementList& list, const std::vector<std::uint32_t>& removed) {
  std::vector<bool> keep(list.nodes.size(), true);
  for (const auto i : removed) keep[i] = false;
  const auto shorten = [&](auto& values) {
    if (values.empty()) return;
    std::size_t n = 0;
    for (std::size_t i = 0; i < keep.size(); ++i)
      if (keep[i]) values[n++] = values[i];
    values.resize(n);
  };
  shorten(list.tags);
  shorten(list.ids);
  shorten(list.lines);
  shorten(list.entities);
  shorten(list.file_positions);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (keep[i]) kept.push_back(i);
  auto [nodes, midside] = selected_nodes(list, kept);
  list.nodes = std::move(nodes);
  list.midside = std::move(midside);
}

/// Removes facets of cells with the nodes and the tag of another one: the seam had them twice.
void remove_doubled_facets(MeshParts& parts) {
  for (int dim = 1; dim < dimension_of(parts); ++dim) {
    ElementList& list = parts.elements[dim];
    CompressedRows<NodeIndex> with_tag;
    std::vector<NodeIndex> row;
    for (std::size_t i = 0; i < list.nodes.size(); ++i) {
      row.assign(list.nodes[i].begin(), list.nodes[i].end());
      std::sort(row.begin(), row.end());
      row.push_back(list.tags.empty() ? 0 : static_cast<NodeIndex>(list.tags[i]));
      with_tag.append(row);
    }
    if (const auto doubled = equal_rows(with_tag); !doubled.empty()) remove_elements(list, doubled);
  }
}

/// Calls visit(place, node) for the midside nodes of all elements.
template <class Visit>
void for_each_midside_node(const MeshParts& parts, const Visit& visit) {
  for (int dim = 1; dim <= 3; ++dim) {
    const ElementList& list = parts.elements[dim];
    for (std::size_t e = 0; e < list.midside.size(); ++e)
      for_each_midside_place(dim, list.nodes[e], list.midside[e], visit);
  }
}

/// Merges the midside nodes of edges and faces whose corners have become the same.
void merge_midside(MeshParts& parts) {
  std::map<MidsidePlace, NodeIndex> first_at;
  for_each_midside_node(parts, [&](const MidsidePlace& place, NodeIndex node) {
    NodeIndex& known = first_at.try_emplace(place, node).first->second;
    known = std::min(known, node);
  });
  if (first_at.empty()) return;
  std::vector<NodeIndex> first(parts.coordinates.size());
  std::iota(first.begin(), first.end(), NodeIndex{0});
  for_each_midside_node(
      parts, [&](const MidsidePlace& place, NodeIndex node) { first[node] = first_at.at(place); });
  renumber_nodes(parts, first);
}

void merge_coincident(MeshParts& parts, std::vector<std::string>& done) {
  const PlainCells cells = cells_of(parts);
  const std::size_t n_before = cells.points.size();
  const auto coincident = find_coincident_nodes(cells, skin_of(cells, FacetTable(cells)));
  if (coincident.count == 0) return;
  NodeIndex node = 0;
  while (coincident.is_first(node)) ++node;
  const std::string place = place_text(cells.points[node], cells.planar);
  renumber_nodes(parts, coincident.first);
  merge_midside(parts);
  remove_doubled_facets(parts);
  done.push_back("merged " + count_of(coincident.count, "coincident node") +
                 " with another node in the same place, " +
                 (coincident.count == 1 ? "" : "the first ") + "at " + place +
                 ": the mesh now has " + std::to_string(n_before - coincident.count) +
                 " nodes instead of " + std::to_string(n_before));
}

/// Number of doubled cells whose tag is not that of the first cell with these nodes.
std::size_t n_of_other_tags(const ElementList& list, const std::vector<CellIndex>& doubled) {
  if (list.tags.empty()) return 0;
  std::map<std::vector<NodeIndex>, int> tags;
  std::vector<bool> is_doubled(list.nodes.size(), false);
  for (const CellIndex c : doubled) is_doubled[c] = true;
  for (const CellIndex c : doubled) tags.try_emplace(sorted_nodes(list.nodes[c]), 0);
  for (CellIndex c = 0; c < list.nodes.size(); ++c)
    if (!is_doubled[c])
      if (const auto found = tags.find(sorted_nodes(list.nodes[c])); found != tags.end())
        found->second = list.tags[c];
  return static_cast<std::size_t>(std::count_if(doubled.begin(), doubled.end(), [&](CellIndex c) {
    return tags[sorted_nodes(list.nodes[c])] != list.tags[c];
  }));
}

void remove_doubled_cells(MeshParts& parts, std::vector<std::string>& done) {
  const auto doubled = doubled_cells(cells_of(parts).cells);
  if (doubled.empty()) return;
  done.push_back("removed " + count_of(doubled.size(), "cell") +
                 " with the same nodes as an earlier cell: " +
                 (doubled.size() == 1 ? "" : "the first is ") + cell_text(parts, doubled.front()));
  ElementList& list = parts.elements[dimension_of(parts)];
  if (const std::size_t n = n_of_other_tags(list, doubled); n > 0)
    done.push_back(std::to_string(n) + " of the removed cells " + (n == 1 ? "has" : "have") +
                   " another tag than the cell that stays");
  remove_elements(list, doubled);
}

void remove_unused_nodes(MeshParts& parts, std::vector<std::string>& done) {
  const std::size_t n_before = parts.coordinates.size();
  drop_unused_nodes(parts);
  if (const std::size_t n = n_before - parts.coordinates.size(); n > 0)
    done.push_back("removed " + count_of(n, "node") + " without cells");
}

}  // namespace

std::vector<std::string> repair_while_reading(MeshParts& parts, const MeshReadOptions& options) {
  std::vector<std::string> done;
  if (!has_possible_cells(parts)) return done;
  if (options.merges) merge_coincident(parts, done);
  if (options.turns_over) turn_over(parts, done);
  return done;
}

std::vector<std::string> repair(MeshParts& parts) {
  require_usable_coordinates(parts);
  require_readable_cells(parts);
  std::vector<std::string> done;
  remove_doubled_cells(parts, done);  // first: they hide the boundary
  merge_coincident(parts, done);
  remove_doubled_cells(parts, done);  // cells that lay in one place
  remove_unused_nodes(parts, done);
  turn_over(parts, done);
  return done;
}

}  // namespace smoothfem
