// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>

#include "meshes/io/mesh_file.h"

namespace smoothfem {

/// Reads the text format of planar polygonal meshes published with the GETMe framework
/// (twt-gmbh/getme). Its lines: `planar_polygonal_mesh`; `nodes N` and N lines `x y`; `polygons M`
/// and M lines of a number k and k node numbers (from 0, counterclockwise); `fixed_node_indices F`
/// and F lines. `polygon_mean_ratio_quality_numbers M` and M lines may follow; their form is
/// checked and their values are ignored.
MeshParts read_polygonal_text(const std::filesystem::path& path, const MeshReadOptions& = {});

/// Writes this format. Coordinates have 17 significant digits, so that reading returns the same
/// values bit for bit. Fixed nodes and mean ratios of the cells are always written; labels and
/// fields are not.
void write_polygonal_text(const std::filesystem::path& path, const MeshView& mesh,
                          const MeshFields& fields, const MeshWriteOptions& options);

}  // namespace smoothfem
