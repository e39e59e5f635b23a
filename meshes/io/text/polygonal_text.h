// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>

#include "meshes/io/mesh_file.h"

namespace smoothfem {

/// The text format of planar polygonal meshes published with the GETMe framework (twt-gmbh/getme):
/// a line `planar_polygonal_mesh`; `nodes N` and N lines `x y`; `polygons M` and M lines of a
/// number k and k node numbers (from 0, counterclockwise); `fixed_node_indices F` and F lines;
/// optionally `polygon_mean_ratio_quality_numbers M` and M lines, which are checked for form and
/// ignored.
MeshFile read_polygonal_text(const std::filesystem::path& path);

/// True if the first line of the content announces this format.
bool is_polygonal_text(std::string_view content);

/// Coordinates have 17 significant digits, so reading gives back the same bits. Fixed nodes and
/// mean ratios of the cells are always written; labels and fields are not.
void write_polygonal_text(const std::filesystem::path& path, const MeshView& mesh,
                          const MeshFields& fields, const MeshWriteOptions& options);

}  // namespace smoothfem
