// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "meshes/io/mesh_file.h"

namespace smoothfem {

struct PlainMesh;  // mesh_assembly.h

/// Reads a legacy .vtk file (unstructured grid or polygonal data, text or binary, versions 1 to 5).
/// Or reads a .vtu file (text or binary, inline or appended, compressed by zlib, LZ4 or LZMA).
/// VTK's readers are not used: a damaged file can crash them, or let them take all memory.
///
/// Cells are tetrahedra, pyramids, wedges, hexahedra and voxels, or of dimension 2 triangles,
/// quadrilaterals, pixels and polygons. Cells of one dimension less with a nonzero entry in the
/// cell array `physical_tag` become labelled facets; other cells of lower dimension are ignored.
/// Also read are the point array `fixed` (not zero: fixed), the arrays `node_id` and `cell_id`, and
/// the field `physical_name`, characters of lines "dimension tag name". All nodes are kept.
///
/// Many programs write wedges in Gmsh's order (node_order.h). That order is used for all wedges if
/// more of them have a positive volume in it than in VTK's order. Throws InputError for incomplete
/// files, cells with mid-edge nodes and other cells.
MeshParts read_legacy_vtk(const std::filesystem::path& path, const MeshReadOptions& options = {});
MeshParts read_vtu(const std::filesystem::path& path, const MeshReadOptions& options = {});

/// Returns the files that a .pvtu file lists, each once. Throws InputError "path:line: ..." if
/// there are none, or if they are not in its folder or below.
std::vector<std::filesystem::path> files_of_pvtu(const std::filesystem::path& path);

/// True if a small .vtu file has pieces, but no cells. Programs write such a file for each process
/// without cells.
bool has_no_cells(const std::filesystem::path& path);

/// Reads the .vtu files that a .pvtu file lists as one mesh. They must be in its folder or below.
/// Ghost cells, which another piece has as well, are left out. Nodes on the seams of pieces stay
/// apart.
MeshParts read_pvtu(const std::filesystem::path& path, const MeshReadOptions& options = {});

/// Writes cells, followed by the labelled facets, the arrays that the readers use (tags, names and
/// numbers if the mesh has them), and the fields; a facet has the value of its cell. Both formats
/// keep every bit of coordinates and fields. .vtk has version 4.2, which external programs still
/// read better than 5.1. A binary .vtu file has inline base64 data, 64-bit headers and no
/// compression.
void write_legacy_vtk(const std::filesystem::path& path, const MeshView& mesh,
                      const MeshFields& fields, const MeshWriteOptions& options);
void write_vtu(const std::filesystem::path& path, const MeshView& mesh, const MeshFields& fields,
               const MeshWriteOptions& options);
/// As above, in the encoding of the file that the mesh comes from.
void write_vtu(const std::filesystem::path& path, const PlainMesh& mesh);

/// Returns VTK's number of a type of cells.
int vtk_type(ElementType type);

}  // namespace smoothfem
