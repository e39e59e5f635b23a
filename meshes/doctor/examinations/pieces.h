// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "meshes/doctor/examinations/facet_table.h"
#include "meshes/doctor/examinations/seams.h"

namespace smoothfem {

/// Returns the number of parts of the mesh that have no node in common.
std::size_t count_pieces(const PlainCells& cells);

/// Returns the nodes whose cells form two or more groups without a common edge there, ascending.
/// Seams are left out: there the hanging or coincident nodes are the fault.
std::vector<NodeIndex> find_touching_nodes(const PlainCells& cells, const Skin& skin,
                                           const std::vector<HangingNode>& hanging,
                                           const CoincidentNodes& coincident);

/// Returns the edges of volume cells with four or more boundary faces: pieces touch there. Seams
/// are left out.
std::vector<std::array<NodeIndex, 2>> find_touching_edges(const PlainCells& cells, const Skin& skin,
                                                          const std::vector<HangingNode>& hanging,
                                                          const CoincidentNodes& coincident);

}  // namespace smoothfem
