// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// Returns the kind of each cell: cells in the same physical groups are of one kind.
std::vector<std::uint32_t> cell_kinds(const Topology& topology);

/// Returns the groups of each kind: their tags and names. A kind without groups has none.
std::vector<std::vector<std::string>> groups_of_kinds(const Topology& topology,
                                                      const std::vector<std::uint32_t>& kinds);

}  // namespace smoothfem
