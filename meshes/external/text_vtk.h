// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "meshes/io/mesh_view.h"

namespace smoothfem {

/// Writes a mesh as legacy VTK text of version 3.0, the only VTK format of some programs. Writes
/// cells, nodes with all digits, and the point data `fixed` (1: the node must not move). Throws
/// InputError if the file cannot be written.
void write_text_vtk(const std::filesystem::path& path, const MeshView& mesh);

}  // namespace smoothfem
