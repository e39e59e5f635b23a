// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "meshes/doctor/finding.h"
#include "meshes/io/mesh_assembly.h"

namespace smoothfem {

/// What check() sees in a mesh.
struct Examination {
  std::string mesh_kind;  ///< planar, volume or surface
  std::size_t n_nodes = 0, n_cells = 0;
  std::size_t n_pieces = 0;  ///< parts without a common node
  std::vector<Finding> findings;
};

/// Throws InputError if there are no cells, or if a cell has an impossible number of nodes or names
/// a node that does not exist.
void require_readable_cells(const MeshParts& parts);

/// Examines the data of a file. Works also for data of which no mesh can be made. Throws InputError
/// as require_readable_cells() and require_usable_coordinates() do.
Examination examine(const MeshParts& parts);

}  // namespace smoothfem
