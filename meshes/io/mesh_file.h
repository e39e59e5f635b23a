// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "meshes/io/mesh_view.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A mesh as read. Cells may be invalid, as the quality command needs to evaluate them. Call
/// require_valid(mesh, path, cell_lines) of smoothing/quality if you need valid cells.
struct MeshFile {
  AnyMesh mesh;  ///< a volume mesh if the file has volume cells, otherwise a planar one, or a
                 ///< surface mesh if z is not constant
  std::vector<std::size_t> cell_lines;  ///< line of each cell in the file; empty if it has none
  std::vector<std::string> notes{};     ///< what was changed in reading, one sentence each
};

struct MeshReadOptions {
  bool turns_over = true;  ///< cells whose only fault is the direction of their nodes
  bool merges = false;     ///< boundary nodes that lie in one place
};

/// Reads a mesh. The format follows from the extension (mesh_formats()); if two formats share one,
/// from the content. Surface cells of volume meshes become labelled facets if they have a tag.
/// Throws InputError "path:line: message"; the line may be missing.
MeshFile read_mesh(const std::filesystem::path& path, const MeshReadOptions& options = {});

/// Returns the planar mesh of a file. Throws InputError that names `path` for any other mesh.
const PlanarMesh& planar_mesh(const MeshFile& file, const std::filesystem::path& path);

/// Named numbers to write with a mesh: one for each cell or one for each node.
struct MeshFields {
  std::map<std::string, std::vector<double>> cell, point;
};

enum class MshVersion { v2_2, v4_1 };

struct MeshWriteOptions {
  MshVersion msh_version = MshVersion::v4_1;
  /// Both keep every bit of the coordinates; text is three times as large.
  bool msh_binary = true;
};

/// Writes a mesh in the format of the extension. If two formats share it, the first one that holds
/// the mesh's dimension is used. The file appears complete or not at all, and missing parent
/// folders are created. Fields that the format cannot hold are left out. Throws InputError for an
/// unknown extension, a cell that the format cannot hold, fields of the wrong length, and files
/// that cannot be written.
void write_mesh(const std::filesystem::path& path, const MeshView& mesh,
                const MeshFields& fields = {}, const MeshWriteOptions& options = {});

/// Checks a name before long work: throws InputError if write_mesh could not write this file.
void require_mesh_path(const std::filesystem::path& path);

struct MeshParts;  // mesh_assembly.h

/// A format: its description for `smoothfem list`, its reader and its writer.
struct MeshFormat {
  std::string name;
  std::string extension;  ///< with the dot
  std::string description;
  bool holds_planar_meshes = false, holds_volume_meshes = false, holds_surface_meshes = false;
  bool holds_polygons = false;        ///< cells with five or more nodes
  bool holds_fixed_nodes = false;     ///< otherwise boundary nodes are fixed after reading
  bool holds_physical_names = false;  ///< labelled facets, and names of tags (all formats but
                                      ///< polygonal text hold the cells' tags)
  bool holds_numbers = false;         ///< numbers of nodes and cells
  /// True if content has this format; needed if formats share an extension. At most one may be
  /// null: the fallback.
  bool (*recognizes)(std::string_view content) = nullptr;
  MeshParts (*read)(const std::filesystem::path&);
  void (*write)(const std::filesystem::path&, const MeshView&, const MeshFields&,
                const MeshWriteOptions&);
};

/// Registers a format when its file is loaded: a namespace-scope object at the end of a file in
/// meshes/io/. A duplicate name is an InputError at the first look-up.
struct RegisteredFormat {
  explicit RegisteredFormat(MeshFormat format);
};

/// Returns all registered formats, sorted by name.
const std::vector<MeshFormat>& mesh_formats();

}  // namespace smoothfem
