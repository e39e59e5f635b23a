// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/doctor/examine.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <set>

#include "meshes/doctor/examinations/orientation.h"
#include "meshes/doctor/examinations/pieces.h"
#include "meshes/doctor/examinations/same_cells.h"
#include "meshes/doctor/examine_boundary.h"
#include "smoothing/geometry/cell_edges.h"
#include "smoothing/mesh/midside_nodes.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/second_order/jacobian_bounds.h"
#include "smoothing/simd/cells.h"

namespace smoothfem {

bool is_invalid(const PlainCells& cells, std::span<const NodeIndex> nodes) {
  const auto at = [&](NodeIndex node) -> const Point<3>& { return cells.points[node]; };
  bool invalid = false;
  if (cells.dim == 3) {
    with_corners_at<3>(nodes, at, [&](auto corners) { invalid = !(mean_ratio(corners) > 0.0); });
    return invalid;
  }
  const Point<3> upper = cells.planar ? Point<3>(0.0, 0.0, 1.0) : facet_normal(nodes, cells.points);
  with_corners_at<2>(
      nodes, at, [&](auto corners) { invalid = !(mean_ratio(vector_of(upper), corners) > 0.0); });
  return invalid;
}

namespace {

void add_directions(Findings& findings, const FacetTable& table) {
  const PlainCells& cells = findings.cells();
  const Orientation orientation = find_reversed_cells(cells, table);
  const auto& reversed = orientation.reversed;
  if (!reversed.empty())
    findings.add(findings.at_cell(FindingKind::reversed_cells, reversed.size(), reversed[0]));
  if (orientation.one_sided)
    findings.add(findings.at_cell(FindingKind::one_sided, 1, *orientation.one_sided));
  const auto right = with_reversed(cells.dim, cells.cells, reversed);
  std::size_t n_folded = 0;
  CellIndex first = 0;
  for (CellIndex c = 0; c < right.size(); ++c)
    if (is_invalid(cells, right[c]) && n_folded++ == 0) first = c;
  if (n_folded > 0) findings.add(findings.at_cell(FindingKind::folded_cells, n_folded, first));
}

/// Adds cells of second order that are not proven valid, although their corners make valid cells.
template <int dim>
void add_bent_cells(Findings& findings, const ElementList& list, const std::vector<bool>& usable) {
  const PlainCells& cells = findings.cells();
  std::size_t n_bent = 0;
  CellIndex first = 0;
  std::vector<Point<dim>> points;
  for (CellIndex c = 0; c < cells.cells.size(); ++c) {
    if (!usable[c] || list.midside_of(c).empty() || is_invalid(cells, cells.cells[c])) continue;
    points.clear();
    for (const auto row : {cells.cells[c], list.midside_of(c)})
      for (const NodeIndex node : row) points.push_back(cells.points[node].template head<dim>());
    if (!is_proven_valid(std::span<const Point<dim>>(points)) && n_bent++ == 0) first = c;
  }
  if (n_bent > 0)
    findings.add(findings.at_cell(FindingKind::bent_cells, n_bent, first),
                 count_of(n_bent, "cell") +
                     (n_bent == 1 ? " has valid corners, but its midside nodes bend it too much"
                                  : " have valid corners, but their midside nodes bend them too "
                                    "much"),
                 "'smoothfem smooth' moves these towards their straight places");
}

/// Adds linear cells with an edge that another cell bends: between both is a gap, or they overlap.
void add_straight_sides(Findings& findings, const ElementList& list) {
  const PlainCells& cells = findings.cells();
  const auto is_linear = [&](CellIndex c) { return list.midside_of(c).empty(); };
  std::set<std::array<NodeIndex, 2>> bent;
  for (CellIndex c = 0; c < cells.cells.size(); ++c)
    for_each_midside_place(
        cells.dim, cells.cells[c], list.midside_of(c),
        [&](const MidsidePlace& place, NodeIndex node) {
          constexpr double rounding = 1e-9;
          if (place[2] != no_corner || place[0] == place[1]) return;  // no edge
          const Point<3>&a = cells.points[place[0]], &b = cells.points[place[1]];
          if ((cells.points[node] - 0.5 * (a + b)).norm() > rounding * (b - a).norm())
            bent.insert({place[0], place[1]});
        });
  std::size_t n = 0;
  CellIndex first = 0;
  for (CellIndex c = 0; c < cells.cells.size() && !bent.empty(); ++c) {
    if (!is_linear(c)) continue;
    bool is_beside = false;
    for_each_edge(cells.dim, cells.cells[c].size(), [&](std::size_t a, std::size_t b) {
      const auto [low, high] = std::minmax(cells.cells[c][a], cells.cells[c][b]);
      is_beside = is_beside || bent.contains({low, high});
    });
    if (is_beside && n++ == 0) first = c;
  }
  if (n > 0)
    findings.add(findings.at_cell(FindingKind::straight_sides, n, first),
                 count_of(n, "linear cell") + (n == 1 ? " has" : " have") +
                     " a straight edge that a neighbour of second order bends, so that they "
                     "overlap or leave a gap",
                 "make the cells of one order in the mesh generator");
}

void add_crowded_facets(Findings& findings, const FacetTable& table) {
  std::size_t count = 0;
  NodeIndex first = 0;
  CellIndex cell = 0;
  table.for_each([&](NodeIndex node, std::span<const CellFacet> facet) {
    if (facet.size() <= 2 || count++ > 0) return;
    first = node;
    cell = facet[2].cell;
  });
  if (count == 0) return;
  auto finding = findings.at_node(FindingKind::crowded_facets, count, first);
  finding.cell = findings.numbers().cell(cell);
  findings.add(finding);
}

/// Adds cells that name a node twice, and cells with the nodes of another one. Returns the rest.
std::vector<bool> add_unusable_cells(Findings& findings) {
  const PlainCells& cells = findings.cells();
  const auto collapsed = collapsed_cells(cells.cells);
  const auto doubled = doubled_cells(cells.cells);
  if (!collapsed.empty())
    findings.add(findings.at_cell(FindingKind::collapsed_cells, collapsed.size(), collapsed[0]));
  if (!doubled.empty())
    findings.add(findings.at_cell(FindingKind::doubled_cells, doubled.size(), doubled[0]));
  std::vector<bool> usable(cells.cells.size(), true);
  for (const auto* unusable : {&collapsed, &doubled})
    for (const CellIndex c : *unusable) usable[c] = false;
  return usable;
}

/// midside: other nodes of the cells than corners.
void add_unused_nodes(Findings& findings, const CompressedRows<NodeIndex>& midside) {
  const PlainCells& cells = findings.cells();
  std::vector<bool> used(cells.points.size(), false);
  for (const NodeIndex node : cells.cells.entries()) used[node] = true;
  for (const NodeIndex node : midside.entries()) used[node] = true;
  const auto count = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
  if (count == 0) return;
  const auto first =
      static_cast<NodeIndex>(std::find(used.begin(), used.end(), false) - used.begin());
  findings.add(findings.at_node(FindingKind::unused_nodes, count, first));
}

/// Cells of which a mesh can be made, with their numbers.
struct UsableCells {
  CompressedRows<NodeIndex> nodes;
  std::vector<std::size_t> numbers;
};
UsableCells usable_cells(const Findings& findings, const std::vector<bool>& usable) {
  UsableCells result;
  for (CellIndex c = 0; c < usable.size(); ++c) {
    if (!usable[c]) continue;
    result.nodes.append(findings.cells().cells[c]);
    result.numbers.push_back(*findings.numbers().cell(c));
  }
  return result;
}

/// Examines cells of which a mesh can be made.
std::vector<Finding> examine_usable(const PlainCells& cells, const FileNumbers& numbers) {
  Findings findings(cells, numbers);
  const FacetTable table(cells);
  add_directions(findings, table);
  add_crowded_facets(findings, table);
  (void)add_seams(findings, skin_of(cells, table));
  return std::move(findings).take();
}

}  // namespace

void require_readable_cells(const MeshParts& parts) {
  const int dim = dimension_of(parts);
  const auto& cells = parts.elements[dim].nodes;
  if (cells.empty()) throw InputError("the mesh has no cells");
  for (CellIndex c = 0; c < cells.size(); ++c) {
    if (!is_cell_size(dim, cells[c].size()))
      throw CellError(c, "has " + count_of(cells[c].size(), "node") + ", which no cell can have");
    for (const NodeIndex node : cells[c])
      if (node >= parts.coordinates.size())
        throw CellError(c, "names node " + std::to_string(node) + ", but the file has only " +
                               count_of(parts.coordinates.size(), "node") + ", counted from 0");
  }
}

Examination examine(const MeshParts& parts) {
  const int dim = dimension_of(parts);
  require_usable_coordinates(parts);
  require_readable_cells(parts);
  const ElementList& list = parts.elements[dim];
  PlainCells cells{dim, list.nodes, parts.coordinates, dim == 2 && is_planar(parts)};
  const PlaneInSpace* plane = parts.content.plane ? &*parts.content.plane : nullptr;
  FileNumbers numbers{true, parts.node_ids, list.ids, plane};
  Examination result{.mesh_kind = mesh_kind_name(dim, dim == 3 || cells.planar ? dim : 3),
                     .n_nodes = parts.coordinates.size(),
                     .n_cells = list.nodes.size(),
                     .n_pieces = count_pieces(cells),
                     .findings = {}};
  Findings findings(cells, numbers);
  const auto usable = add_unusable_cells(findings);
  add_unused_nodes(findings, list.midside);
  if (!list.midside.empty()) add_straight_sides(findings, list);
  if (dim == 3)
    add_bent_cells<3>(findings, list, usable);
  else if (cells.planar)
    add_bent_cells<2>(findings, list, usable);
  std::vector<Finding> more;
  if (std::find(usable.begin(), usable.end(), false) == usable.end()) {
    more = examine_usable(cells, numbers);
  } else if (const auto rest = usable_cells(findings, usable); !rest.nodes.empty()) {
    more = examine_usable({dim, rest.nodes, parts.coordinates, cells.planar},
                          {true, parts.node_ids, rest.numbers, plane});
  }
  result.findings = std::move(findings).take();
  result.findings.insert(result.findings.end(), more.begin(), more.end());
  return result;
}

}  // namespace smoothfem
