// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <optional>
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
                 ///< surface mesh if its points do not lie in a plane
  std::vector<std::size_t> cell_lines;  ///< line of each cell in the file; empty if it has none
  std::vector<std::string> notes{};     ///< what was left out or changed, one sentence each
};

struct MeshReadOptions {
  bool turns_over = true;   ///< cells whose only fault is the direction of their nodes
  bool merges = false;      ///< boundary nodes that lie in one place
  std::string tag_field{};  ///< name of the cell array with tags, in VTK files; empty: a known one
};

/// Reads a mesh. The format follows from the extension and from how the file begins: a file under
/// the name of another format is read as what it is, with a note. Surface cells of volume meshes
/// become labelled facets if they have a tag. Throws InputError "path:line: message"; the line may
/// be missing.
MeshFile read_mesh(const std::filesystem::path& path, const MeshReadOptions& options = {});

/// Returns the planar mesh of a file. Throws InputError that names `path` for any other mesh.
const PlanarMesh& planar_mesh(const MeshFile& file, const std::filesystem::path& path);

/// Named numbers to write with a mesh: one for each cell or one for each node.
struct MeshFields {
  std::map<std::string, std::vector<double>> cell, point;
};

enum class MshVersion { v2_2, v4_1 };

/// Version and encoding of .msh, .vtk and .vtu files. Default: those of the file that the mesh
/// comes from, if it has the same format; otherwise binary files, .msh of version 4.1.
struct MeshWriteOptions {
  std::optional<MshVersion> msh_version{};
  /// Both keep every bit of the coordinates; text is three times as large.
  std::optional<bool> binary{};
};

/// A format to write in, and its version and encoding.
struct WriteTarget {
  std::string extension;  ///< with the dot; empty: as the file's name says
  MeshWriteOptions options;
};
/// Parses a user's wish: an extension with or without the dot, or msh22 or msh41. Formats with two
/// encodings may end with "-text" or "-binary"; for example "msh22-text". Empty text: no wish.
/// Throws InputError.
WriteTarget parse_write_target(const std::string& text);

/// Writes a mesh in the format of the extension. If two formats share it, the first one that holds
/// the mesh's dimension is used. The file appears complete or not at all, and missing parent
/// folders are created. Fields that the format cannot hold are left out. Throws InputError for an
/// unknown extension, a cell that the format cannot hold, fields of the wrong length, and files
/// that cannot be written.
void write_mesh(const std::filesystem::path& path, const MeshView& mesh,
                const MeshFields& fields = {}, const MeshWriteOptions& options = {});

/// Checks a name before long work: throws InputError if write_mesh could not write this file.
void require_mesh_path(const std::filesystem::path& path);

/// Returns the extension for a changed mesh of a file, with the dot: its own one if such files are
/// written, otherwise ".vtu".
std::string extension_to_write(const std::filesystem::path& path);

struct MeshParts;  // mesh_assembly.h

/// A format: its description for `smoothfem list`, its reader and its writer.
struct MeshFormat {
  std::string name;
  std::string extension;  ///< with the dot
  std::string description;
  std::vector<std::string> other_extensions{};
  bool holds_planar_meshes = false, holds_volume_meshes = false, holds_surface_meshes = false;
  bool holds_polygons = false;        ///< cells with five or more nodes
  bool holds_second_order = false;    ///< elements with midside nodes
  bool holds_tags = true;             ///< tags of cells
  bool holds_fixed_nodes = false;     ///< otherwise boundary nodes are fixed after reading
  bool adds_fixed_nodes = false;      ///< to those of the boundary
  bool holds_facets = false;          ///< labelled facets
  bool holds_physical_names = false;  ///< labelled facets, and names of tags
  bool holds_numbers = false;         ///< numbers of nodes and cells
  bool holds_several_groups = false;  ///< elements in more than one group
  bool holds_periodic = false;        ///< periodic partners
  bool holds_points_in_space = true;  ///< planar meshes in any plane
  bool has_two_encodings = false;     ///< text and binary
  bool takes_tag_field = false;       ///< MeshReadOptions::tag_field
  int min_element_dimension = 2;      ///< of elements without a label
  /// True if the format can hold a field, at nodes or elements or of the whole file; null: none.
  bool (*holds_field)(const MeshField&, bool is_of_file) = nullptr;
  /// True if a file of this format begins so (n_recognized bytes, or the whole file). If several
  /// formats share an extension, it may be null for one of them: the fallback.
  bool (*recognizes)(std::string_view beginning) = nullptr;
  MeshParts (*read)(const std::filesystem::path&, const MeshReadOptions&);
  /// Null for formats that are only read.
  void (*write)(const std::filesystem::path&, const MeshView&, const MeshFields&,
                const MeshWriteOptions&) = nullptr;
};

/// Number of bytes by which a format is recognized.
constexpr std::size_t n_recognized = 4096;

/// Returns the format in which write_mesh writes a mesh to a file of this name: the one that the
/// mesh was read from if it has the same extension, otherwise the one that can hold most of it.
/// Throws InputError if there is none.
const MeshFormat& format_for(const std::filesystem::path& path, const MeshView& mesh);

/// Registers a format when its file is loaded: a namespace-scope object at the end of a file in
/// meshes/io/. A duplicate name is an InputError at the first look-up.
struct RegisteredFormat {
  explicit RegisteredFormat(MeshFormat format);
};

/// Returns all registered formats, sorted by name.
const std::vector<MeshFormat>& mesh_formats();

}  // namespace smoothfem
