#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A mesh as read. Cells may be invalid (the quality command has to be able to look at them): who
/// needs valid ones calls require_valid(mesh, path, cell_lines) of smoothing/quality.
struct MeshFile {
  PlanarMesh mesh;
  std::vector<std::size_t> cell_lines;  ///< line of each cell in the file; empty if it has none
};

/// Reads a planar mesh. The format follows from the extension (mesh_formats()), where two formats
/// share one from the content. Throws InputError, "path:line: what is wrong" where there is a line.
MeshFile read_mesh(const std::filesystem::path& path);

/// Named numbers to write along with a mesh: one a cell, one a node.
struct MeshFields {
  std::map<std::string, std::vector<double>> cell, point;
};

enum class MshVersion { v2_2, v4_1 };

struct MeshWriteOptions {
  MshVersion msh_version = MshVersion::v4_1;
  /// Gmsh prints 16 digits in text files: one too few to get every coordinate back, and enough of a
  /// difference to make a barely valid cell invalid. Binary files are exact.
  bool msh_binary = true;
};

/// Writes a mesh in the format of the extension; the file appears in one piece or not at all, and
/// missing parent folders are created. Fields that the format cannot hold are left out. Throws
/// InputError for an extension or a cell the format cannot hold, fields of the wrong length, and
/// files that cannot be written.
void write_mesh(const std::filesystem::path& path, const PlanarMesh& mesh,
                const MeshFields& fields = {}, const MeshWriteOptions& options = {});

/// What `smoothfem list` says about a format, and how it is read and written.
struct MeshFormat {
  std::string name;
  std::string extension;  ///< with the dot
  std::string description;
  bool holds_polygons;        ///< cells with five and more nodes
  bool holds_fixed_nodes;     ///< otherwise boundary nodes are fixed after reading
  bool holds_fields;          ///< MeshFields are written
  bool holds_physical_names;  ///< labels of cells and boundary edges with names (all but polygonal
                              ///< text keep the cells' tags)
  MeshFile (*read)(const std::filesystem::path&);
  void (*write)(const std::filesystem::path&, const PlanarMesh&, const MeshFields&,
                const MeshWriteOptions&);
};

const std::vector<MeshFormat>& mesh_formats();

}  // namespace smoothfem
