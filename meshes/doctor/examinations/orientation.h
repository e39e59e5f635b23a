// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "meshes/doctor/examinations/facet_table.h"

namespace smoothfem {

/// Outcome of find_reversed_cells.
struct Orientation {
  std::vector<CellIndex> reversed;  ///< cells whose nodes run in the wrong direction, ascending
  /// First cell of a piece that cannot be oriented: its surface has one side only.
  std::optional<CellIndex> one_sided;
};

/// Finds the cells whose only fault is the direction of their nodes. Cells that share a facet have
/// to go around it in opposite directions. This rule orients each piece of the mesh up to its sign.
/// The sign follows from the sum of the cells' areas or volumes, which depends on the boundary
/// only. A folded cell is negative in spite of a right direction, so it is not found here. In a
/// surface mesh the smaller part of a piece is the wrong one.
Orientation find_reversed_cells(const PlainCells& cells);
Orientation find_reversed_cells(const PlainCells& cells, const FacetTable& table);

/// Returns the area or volume of a cell. It is negative for planar and volume cells that are
/// reversed or folded.
double signed_size(const PlainCells& cells, CellIndex cell);

/// Returns for each corner of a reversed cell its position in the cell before.
std::vector<LocalIndex> reversed_corners(int dim, std::size_t n_corners);

/// Returns the cells with the direction of some of them changed. These keep their first node.
CompressedRows<NodeIndex> with_reversed(int dim, const CompressedRows<NodeIndex>& cells,
                                        std::span<const CellIndex> reversed);

}  // namespace smoothfem
