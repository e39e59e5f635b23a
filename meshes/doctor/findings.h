// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "meshes/doctor/examinations/facet_table.h"
#include "meshes/doctor/finding.h"

namespace smoothfem {

/// Numbers of nodes and cells in the file, or from 0 where it has none, and the plane in space if
/// points have the coordinates of one. Default: no numbers are shown.
struct FileNumbers {
  bool are_shown = false;
  std::span<const std::size_t> nodes{}, cells{};
  const PlaneInSpace* plane = nullptr;

  /// Returns a point as the file has it.
  Point<3> place(const Point<3>& p) const {
    return plane ? plane->origin + p.x() * plane->x_axis + p.y() * plane->y_axis : p;
  }
  std::optional<std::size_t> node(NodeIndex i) const { return number(nodes, i); }
  std::optional<std::size_t> cell(CellIndex c) const { return number(cells, c); }

 private:
  std::optional<std::size_t> number(std::span<const std::size_t> ids, std::size_t i) const {
    if (!are_shown) return std::nullopt;
    return ids.empty() || ids[i] == 0 ? i : ids[i];
  }
};

/// The beginning and the end of a finding's sentence.
struct FaultText {
  std::string fault, remedy;
};

/// Returns the texts of the kinds whose sentence depends on nothing but their count and the kind of
/// mesh: those of examine() that no other examination shares.
FaultText text_of(FindingKind kind, std::size_t count, int dim, bool planar);

/// True if repair() removes faults of this kind.
bool is_repairable(FindingKind kind);

/// Collects findings about cells.
class Findings {
 public:
  explicit Findings(const PlainCells& cells, const FileNumbers& numbers = {})
      : cells_(cells), numbers_(numbers) {}

  const PlainCells& cells() const { return cells_; }
  const FileNumbers& numbers() const { return numbers_; }
  const char* facet_name() const { return cells_.dim == 2 ? "edge" : "face"; }

  /// Returns a finding without a sentence whose first place is a node, or a cell.
  Finding at_node(FindingKind kind, std::size_t count, NodeIndex node) const {
    const Point<3> at = numbers_.place(cells_.points[node]);
    return {kind, count, at, std::nullopt, numbers_.node(node), {}, is_repairable(kind)};
  }
  Finding at_cell(FindingKind kind, std::size_t count, CellIndex cell) const {
    const Point<3> at = numbers_.place(cells_.points[cells_.cells[cell][0]]);
    return {kind, count, at, numbers_.cell(cell), std::nullopt, {}, is_repairable(kind)};
  }

  /// Adds a finding. Its sentence says the fault, the first place and the remedy.
  void add(Finding finding, const std::string& fault, const std::string& remedy) {
    std::string place = finding.count == 1 ? "it is " : "the first is ";
    if (finding.node)
      place += "node " + std::to_string(*finding.node) + " ";
    else if (finding.cell)
      place += "cell " + std::to_string(*finding.cell) + " ";
    place += "at " + place_text(finding.at, cells_.planar && !numbers_.plane);
    finding.sentence = fault + "; " + place + "; " + remedy;
    all_.push_back(std::move(finding));
  }

  /// As above, with the texts of its kind.
  void add(Finding finding) {
    const auto [fault, remedy] =
        text_of(finding.kind, finding.count, cells_.dim, cells_.dim == 2 && cells_.planar);
    add(std::move(finding), fault, remedy);
  }

  std::vector<Finding> take() && { return std::move(all_); }

 private:
  const PlainCells& cells_;
  FileNumbers numbers_;
  std::vector<Finding> all_;
};

}  // namespace smoothfem
