// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>

#include "meshes/io/mesh_file.h"

namespace smoothfem {

/// Reads Medit's text format (MeshVersionFormatted, Dimension 2 or 3; Frey, Medit: an interactive
/// mesh visualization software, 2001). Tetrahedra, Hexahedra, Prisms and Pyramids make a volume
/// mesh, in this order. Without them Triangles and Quadrilaterals make a planar mesh. References
/// are the physical tags (0: none) of cells and facets. References of vertices, required elements,
/// corners, ridges and the solution next to the mesh (.sol) become fields. RequiredVertices are
/// fixed in addition to the boundary nodes. All nodes are kept. Each section may end with End. A
/// file without a final End is accepted if it ends after a complete section and a line's end.
/// Throws InputError for elements with mid-nodes.
MeshParts read_medit_text(const std::filesystem::path& path, const MeshReadOptions& = {});

/// True if the first word of the content announces this format.
bool is_medit_text(std::string_view content);

/// Writes volume meshes only. Coordinates keep every bit. Cells are written type by type, which
/// changes the order of mixed meshes. Names and numbers are not written, and
/// boundary nodes are fixed after reading. Fields of a solution are written next to the mesh.
void write_medit_text(const std::filesystem::path& path, const MeshView& mesh,
                      const MeshFields& fields, const MeshWriteOptions& options);

/// Writes a mesh for external programs: planar meshes as well (Dimension 2), and all facets of the
/// boundary, those without a label with reference 0. Some programs fix the nodes of these facets
/// only. Throws InputError for cells with five or more nodes of planar meshes, and for files that
/// cannot be written.
void write_medit_with_boundary(const std::filesystem::path& path, const MeshView& mesh);

}  // namespace smoothfem
