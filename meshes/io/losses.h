// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "meshes/io/mesh_file.h"
#include "meshes/io/mesh_view.h"

namespace smoothfem {

/// True for a field that smoothfem writes itself, as it has it anew: the mean ratio of cells.
bool is_own_field(const MeshField& field);

/// Returns what a mesh says that a file of this name cannot hold, so that write_mesh leaves it out:
/// for example "the names and labels of facets". options: as for write_mesh. Throws InputError as
/// write_mesh does if the format cannot hold the mesh.
std::vector<std::string> losses(const std::filesystem::path& path, const MeshView& mesh,
                                const MeshWriteOptions& options = {});

/// Returns the same for a format that can hold the mesh.
std::vector<std::string> losses(const MeshFormat& format, const MeshView& mesh,
                                const MeshWriteOptions& options = {});

}  // namespace smoothfem
