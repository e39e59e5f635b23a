// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>

#include "meshes/io/mesh_file.h"

namespace smoothfem {

/// Reads Medit's text format (MeshVersionFormatted, Dimension 2 or 3; Frey, Medit: an interactive
/// mesh visualization software, 2001). Tetrahedra, Hexahedra, Prisms and Pyramids make a volume
/// mesh, in this order; without them Triangles and Quadrilaterals a planar one. References are the
/// physical tags (0: none) of cells and facets; those of vertices are ignored, as are sections that
/// are not named here. RequiredVertices are fixed besides the boundary nodes. All nodes are kept.
/// Sections may each have an End of their own. Without its last word, End, a file is taken if it
/// ends behind a complete section and a line's end. Refused: elements with mid-nodes.
MeshFile read_medit_text(const std::filesystem::path& path);

/// True if the first word of the content announces this format.
bool is_medit_text(std::string_view content);

/// Volume meshes only. Coordinates are read back bit by bit. Cells are written type by type, which
/// changes the order of mixed meshes; names, numbers and fields are not written, nor that a
/// boundary node is free.
void write_medit_text(const std::filesystem::path& path, const MeshView& mesh,
                      const MeshFields& fields, const MeshWriteOptions& options);

/// For other programs: planar meshes as well (Dimension 2), and all facets of the boundary, those
/// without label with reference 0. Some programs fix the nodes of these and no others. Throws
/// InputError for cells with five nodes and more of planar meshes, and files that cannot be
/// written.
void write_medit_with_boundary(const std::filesystem::path& path, const MeshView& mesh);

}  // namespace smoothfem
