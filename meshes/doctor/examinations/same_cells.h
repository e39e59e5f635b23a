// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "smoothing/mesh/compressed_rows.h"
#include "smoothing/mesh/point.h"

namespace smoothfem {

/// Returns the rows that have a node twice, ascending.
std::vector<std::uint32_t> collapsed_cells(const CompressedRows<NodeIndex>& cells);

/// Returns the rows with the nodes of an earlier row, in any order; ascending.
std::vector<std::uint32_t> doubled_cells(const CompressedRows<NodeIndex>& cells);

/// Returns the rows that are equal to an earlier row, ascending.
std::vector<std::uint32_t> equal_rows(const CompressedRows<NodeIndex>& rows);

}  // namespace smoothfem
