// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "meshes/doctor/examinations/facet_table.h"
#include "meshes/doctor/finding.h"
#include "meshes/io/mesh_assembly.h"

namespace smoothfem {

/// What check() sees in a mesh.
struct Examination {
  std::string mesh_kind;  ///< planar, volume or surface
  std::size_t n_nodes = 0, n_cells = 0;
  std::size_t n_pieces = 0;  ///< parts without a common node
  std::vector<Finding> findings;
  std::vector<std::string> not_looked_for{};  ///< what the examination leaves out, a sentence each
};

/// True if a mesh would count the cell as invalid. Cells in space have their own mean normal.
bool is_invalid(const PlainCells& cells, std::span<const NodeIndex> nodes);

/// Throws InputError if there are no cells, or if a cell has an impossible number of nodes or names
/// a node that does not exist.
void require_readable_cells(const MeshParts& parts);

/// Examines the data of a file. Works also for data of which no mesh can be made. Throws InputError
/// as require_readable_cells() and require_usable_coordinates() do.
Examination examine(const MeshParts& parts);

}  // namespace smoothfem
