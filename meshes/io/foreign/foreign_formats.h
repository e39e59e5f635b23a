// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "meshes/io/mesh_file.h"

namespace smoothfem {

/// Returns the formats that VTK and meshio read and write for this program: Exodus, CGNS, XDMF, and
/// the surfaces STL, OBJ and PLY. A Python process translates them from and to .vtu files. So a
/// file that crashes a library does not end this program, and the start of this program does not
/// wait for the libraries. They are not part of mesh_formats().
const std::vector<MeshFormat>& foreign_formats();

}  // namespace smoothfem
