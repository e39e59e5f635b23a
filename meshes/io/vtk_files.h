#pragma once

#include <filesystem>
#include <string_view>

#include "meshes/io/mesh_file.h"

namespace smoothfem {

/// Read a legacy .vtk file (unstructured grid or polygonal data, text or binary) or a .vtu file
/// (every encoding VTK knows). Cells are triangles, quadrilaterals, pixels and polygons. Lines
/// whose entry of the cell array `physical_tag` is not zero become labelled edges; other lines and
/// vertices are ignored. The point array `fixed` (not zero = fixed) and the cell array
/// `physical_tag` are honoured. All nodes are kept. Refused: incomplete files, a z coordinate that
/// is not constant, other cells.
MeshFile read_legacy_vtk(const std::filesystem::path& path);
MeshFile read_vtu(const std::filesystem::path& path);

/// Write cells, the point array `fixed`, `physical_tag` if the mesh has tags, and the fields.
/// Both keep every bit of coordinates and fields: .vtk is written binary (format version 4.2, which
/// other programs still read better than 5.1; VTK's text files have 11 digits), .vtu with inline
/// base64 data, 64-bit headers and no compression.
void write_legacy_vtk(const std::filesystem::path& path, const PlanarMesh& mesh,
                      const MeshFields& fields, const MeshWriteOptions& options);
void write_vtu(const std::filesystem::path& path, const PlanarMesh& mesh, const MeshFields& fields,
               const MeshWriteOptions& options);

/// Checks that the rows of the cell sections of a legacy file (versions below 5) fill exactly the
/// announced size, which VTK relies on. Throws InputError that names the section.
void check_legacy_vtk_cells(const std::filesystem::path& path, std::string_view content);

}  // namespace smoothfem
