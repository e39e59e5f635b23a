// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "meshes/io/mesh_file.h"

namespace smoothfem {

/// Read a legacy .vtk file (unstructured grid or polygonal data, text or binary, versions 1 to 5)
/// or a .vtu file (text or binary, inline or appended, compressed by zlib, LZ4 or LZMA). VTK's own
/// readers are not asked: a damaged file can crash them, or let them take all memory. Cells are
/// tetrahedra, pyramids, wedges, hexahedra and voxels, or of dimension 2 triangles, quadrilaterals,
/// pixels and polygons. Cells of one dimension less whose entry
/// of the cell array `physical_tag` is not zero become labelled facets; other cells of lower
/// dimension are ignored. Honoured are also the point array `fixed` (not zero = fixed), the arrays
/// `node_id` and `cell_id`, and the field `physical_name`, characters of lines "dimension tag
/// name". All nodes are kept. Many programs write wedges in Gmsh's order (node_order.h): if more of
/// a file's wedges have a positive volume in that order than in VTK's, it is taken for all of them.
/// Refused: incomplete files, cells with mid-edge nodes, other cells.
MeshFile read_legacy_vtk(const std::filesystem::path& path);
MeshFile read_vtu(const std::filesystem::path& path);

/// Write cells, behind them the labelled facets, what the readers honour (tags, names and numbers
/// if the mesh has them), and the fields, in which a facet has the value of its cell. Both keep
/// every bit of coordinates and fields: .vtk is written binary (format version 4.2, which other
/// programs still read better than 5.1; VTK's text files have 11 digits), .vtu with inline base64
/// data, 64-bit headers and no compression.
void write_legacy_vtk(const std::filesystem::path& path, const MeshView& mesh,
                      const MeshFields& fields, const MeshWriteOptions& options);
void write_vtu(const std::filesystem::path& path, const MeshView& mesh, const MeshFields& fields,
               const MeshWriteOptions& options);

/// VTK's number of a type of cells.
int vtk_type(ElementType type);

}  // namespace smoothfem
