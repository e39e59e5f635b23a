// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/io/nearby_file.h"
#include "meshes/io/vtk/vtk_files.h"
#include "meshes/io/vtk/vtk_grid.h"
#include "meshes/io/vtk/vtu_file.h"
#include "meshes/io/vtk/xml_tags.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

constexpr std::string_view ghost_array = "vtkGhostType";

/// Reads the pieces of files as one grid.
class VtuReader {
 public:
  /// Adds the pieces of a file.
  void add(VtuFile& file) {
    file_ = &file;
    for (const VtuPiece& piece : file.pieces()) read_piece(piece);
    for (const VtuArray& array : file.field_data()) read_file_array(array);
    grid_.is_binary = grid_.is_binary || file.has_binary_array();
  }

  VtkGrid grid() && {
    leave_out_ghosts();
    return std::move(grid_);
  }

 private:
  /// Removes ghost cells and the marks of points. Those of cells were not kept.
  void leave_out_ghosts() {
    if (!has_marks_) return;
    std::erase_if(grid_.point_fields,
                  [](const MeshField& field) { return field.name == ghost_array; });
    VtkCells kept;
    std::vector<std::size_t> rows;
    for (std::size_t c = 0; c < grid_.cells.size(); ++c) {
      if (is_ghost_[c]) continue;
      rows.push_back(c);
      for (RowOffset k = grid_.cells.offsets[c]; k < grid_.cells.offsets[c + 1]; ++k)
        kept.nodes.push_back(grid_.cells.nodes[k]);
      kept.end_cell();
      kept.types.push_back(grid_.cells.types[c]);
    }
    const std::size_t n_ghosts = grid_.cells.size() - rows.size();
    if (n_ghosts == 0) return;
    grid_.cells = std::move(kept);
    grid_.has_unused_points = true;
    grid_.notes.push_back(std::to_string(n_ghosts) +
                          " ghost cells, which another piece has, are left out");
    for (MeshField& field : grid_.cell_fields) keep_rows(field, rows);
  }

  static void keep_rows(MeshField& field, const std::vector<std::size_t>& rows) {
    std::visit(
        [&](auto& values) {
          const std::size_t n = field.n_components;
          std::decay_t<decltype(values)> kept;
          for (const std::size_t row : rows)
            for (std::size_t k = 0; k < n; ++k) kept.push_back(values[row * n + k]);
          values = std::move(kept);
        },
        field.values);
  }

  void read_piece(const VtuPiece& piece) {
    const std::size_t first_point = grid_.points.size(), first_cell = grid_.cells.size();
    if (piece.n_points > 0) read_points(piece);
    if (piece.n_cells > 0) grid_.cells.append(read_cells(piece), first_point);
    read_ghosts(piece);
    read_roles(piece, "PointData", grid_.point_roles);
    read_roles(piece, "CellData", grid_.cell_roles);
    if (piece.n_points > 0)
      read_arrays(piece, "PointData", piece.n_points, first_point == 0, grid_.point_fields);
    if (piece.n_cells > 0)
      read_arrays(piece, "CellData", piece.n_cells, first_cell == 0, grid_.cell_fields);
  }

  /// True for an array that marks cells which another piece has as well.
  bool marks_ghosts(const VtuArray& array) const {
    return array.name == ghost_array && array.n_components == 1 && file_->has_numbers(array) &&
           is_integer(file_->type_of(array));
  }

  /// A piece without marks has no ghost cells.
  void read_ghosts(const VtuPiece& piece) {
    constexpr std::int64_t duplicate = 1;  // vtkDataSetAttributes::DUPLICATECELL
    const VtuArray* marks = piece.array("CellData", ghost_array);
    if (marks && marks_ghosts(*marks)) {
      has_marks_ = true;
      file_->read<AnyInteger>(
          *marks, piece.n_cells, [] {},
          [&](AnyInteger mark) { is_ghost_.push_back((mark.value & duplicate) != 0); });
    }
    is_ghost_.resize(grid_.cells.size(), false);
  }

  /// Adds those of a piece that the pieces before it do not have.
  static void read_roles(const VtuPiece& piece, std::string_view section,
                         std::map<std::string, std::string>& roles) {
    if (const auto found = piece.roles.find(section); found != piece.roles.end())
      roles.insert(found->second.begin(), found->second.end());
  }

  const VtuArray& required(const VtuPiece& piece, const std::string& section,
                           const std::string& name) const {
    if (const VtuArray* array = piece.array(section, name)) return *array;
    file_->fail("an element <Piece> has no array " + (name.empty() ? "" : "'" + name + "' ") +
                "in <" + section + ">; the file is damaged");
  }

  void read_points(const VtuPiece& piece) {
    const VtuArray& array = required(piece, "Points", "");
    if (array.n_components != 3)
      file_->fail(array,
                  "has " + std::to_string(array.n_components) + " components, but points have 3");
    if (piece.n_points > UINT32_MAX) file_->fail(array, "would have too many points");
    Point<3> point;
    Eigen::Index component = 0;
    file_->read<double>(
        array, 3 * piece.n_points,
        [&] { grid_.points.reserve(grid_.points.size() + piece.n_points); },
        [&](double value) {
          point[component++] = value;
          if (component < 3) return;
          grid_.points.push_back(point);
          component = 0;
        });
  }

  VtkCells read_cells(const VtuPiece& piece) {
    VtkCells cells;
    const VtuArray& offsets = required(piece, "Cells", "offsets");
    file_->read<std::int64_t>(
        offsets, piece.n_cells, [&] { cells.offsets.reserve(piece.n_cells + 1); },
        [&](std::int64_t offset) {
          if (offset < cells.offsets.back() || offset > std::numeric_limits<RowOffset>::max())
            file_->fail(offsets, "does not ascend at cell " + std::to_string(cells.size()) +
                                     "; the file is damaged");
          cells.offsets.push_back(static_cast<RowOffset>(offset));
        });
    const VtuArray& nodes = required(piece, "Cells", "connectivity");
    file_->read<std::int64_t>(
        nodes, cells.offsets.back(), [&] { cells.nodes.reserve(cells.offsets.back()); },
        [&](std::int64_t point) {
          if (!cells.add_node(point, piece.n_points))
            file_->fail(cells.missing_point(point, piece.n_points));
        });
    const VtuArray& types = required(piece, "Cells", "types");
    file_->read<std::int64_t>(
        types, piece.n_cells, [&] { cells.types.reserve(piece.n_cells); },
        [&](std::int64_t type) {
          if (type < 0 || type > 255)
            file_->fail(types, "has " + std::to_string(type) + ", which is not a VTK cell type");
          cells.types.push_back(static_cast<std::uint8_t>(type));
        });
    return cells;
  }

  /// Reads the arrays of a piece. Only arrays of all pieces are kept.
  void read_arrays(const VtuPiece& piece, std::string_view section, std::uint64_t n, bool is_first,
                   std::vector<MeshField>& fields) {
    const auto found = piece.sections.find(section);
    std::set<std::string, std::less<>> names;
    if (found != piece.sections.end())
      for (const VtuArray& array : found->second) {
        const std::string name(array.name);
        if (piece.array(section, array.name) != &array) continue;
        if (section == "CellData" && marks_ghosts(array)) continue;
        const auto same = std::find_if(fields.begin(), fields.end(), [&](const MeshField& field) {
          return field.name == name && field.n_components == array.n_components;
        });
        if (!file_->has_numbers(array) || (!is_first && same == fields.end())) {
          leave_out(name,
                    file_->has_numbers(array) ? "not all pieces have it" : "it has no numbers");
          continue;
        }
        if (is_first) {
          append_values(array, n, fields.emplace_back(new_field(array)));
        } else {
          append_values(array, n, *same);
        }
        names.insert(name);
      }
    std::erase_if(fields, [&](const MeshField& field) {
      if (names.contains(field.name)) return false;
      leave_out(field.name, "not all pieces have it");
      return true;
    });
  }

  void leave_out(const std::string& name, const std::string& reason) {
    const std::string note = "the array '" + name + "' is left out: " + reason;
    if (std::find(grid_.notes.begin(), grid_.notes.end(), note) == grid_.notes.end())
      grid_.notes.push_back(note);
  }

  MeshField new_field(const VtuArray& array) const {
    MeshField field{.name = std::string(array.name),
                    .n_components = array.n_components,
                    .type = file_->type_of(array)};
    if (is_integer(field.type)) field.values.emplace<std::vector<std::int64_t>>();
    return field;
  }

  void append_values(const VtuArray& array, std::uint64_t n, MeshField& field) {
    if (array.n_components == 0 || std::max<std::uint64_t>(n, array.n_components) > UINT32_MAX)
      file_->fail(array, "would have " + std::to_string(n) + " values of " +
                             std::to_string(array.n_components) + " components");
    const std::uint64_t n_values = n * array.n_components;
    std::visit(
        [&](auto& values) {
          using Value = typename std::decay_t<decltype(values)>::value_type;
          const auto start = [&] { values.reserve(values.size() + n_values); };
          if constexpr (std::is_same_v<Value, double>)
            file_->read<AnyNumber>(array, n_values, start,
                                   [&](AnyNumber number) { values.push_back(number.value); });
          else
            file_->read<AnyInteger>(array, n_values, start,
                                    [&](AnyInteger number) { values.push_back(number.value); });
        },
        field.values);
  }

  void read_file_array(const VtuArray& array) {
    const std::string name(array.name);
    if (!file_->has_numbers(array)) return leave_out(name, "it has no numbers");
    auto& known = grid_.file_fields;
    const bool is_known = name == vtk_names_array
                              ? !grid_.physical_names.empty()
                              : std::any_of(known.begin(), known.end(),
                                            [&](const auto& field) { return field.name == name; });
    if (is_known) return;  // of the file before this one
    MeshField field = new_field(array);
    append_values(array, array.n_tuples, field);
    if (name != vtk_names_array) {
      grid_.file_fields.push_back(std::move(field));
      return;
    }
    for (std::size_t i = 0; i < field.n_rows(); ++i)
      grid_.physical_names += vtk_character(field.number(i * field.n_components));
  }

  VtuFile* file_ = nullptr;  ///< that is being read
  VtkGrid grid_;
  bool has_marks_ = false;
  std::vector<bool> is_ghost_;  ///< for each cell
};

/// Frees the text before the mesh is made of its parts: large meshes would need more memory.
VtkGrid grid_of_files(const std::vector<std::filesystem::path>& paths) {
  VtuReader reader;
  for (const auto& path : paths) {
    VtuFile file(path, read_whole_file(path));
    reader.add(file);
  }
  return std::move(reader).grid();
}

MeshParts vtu_parts(const std::filesystem::path& path, VtkGrid grid,
                    const MeshReadOptions& options) {
  auto parts = parts_of_grid(path.string(), std::move(grid), options.tag_field);
  parts.content.format = "vtu";
  return parts;
}

/// Makes nodes of one number and one place one, which several pieces have. Returns a text on them.
std::string join_pieces(MeshParts& parts) {
  const auto* const global = global_ids(parts.content.node_roles, parts.content.node_fields);
  if (!global && parts.node_ids.empty())
    return "; the pieces have no numbers of nodes, so that nodes between them are several";
  std::map<std::int64_t, NodeIndex> first_of;
  std::vector<NodeIndex> first(parts.coordinates.size());
  std::size_t n_joined = 0;
  for (NodeIndex i = 0; i < first.size(); ++i) {
    first[i] = i;
    if (!global && parts.node_ids[i] == 0) continue;  // it has no number
    const std::int64_t number =
        global ? (*global)[i] : static_cast<std::int64_t>(parts.node_ids[i]);
    const NodeIndex earlier = first_of.try_emplace(number, i).first->second;
    if (parts.coordinates[earlier] != parts.coordinates[i]) continue;
    first[i] = earlier;
    n_joined += earlier != i;
  }
  renumber_nodes(parts, first);
  return "; by their numbers, " + std::to_string(n_joined) + " nodes are those of earlier pieces";
}

}  // namespace

const std::vector<std::int64_t>* global_ids(const std::map<std::string, std::string>& roles,
                                            const std::vector<MeshField>& fields) {
  const auto name = roles.find(global_ids_role);
  if (name == roles.end()) return nullptr;
  for (const MeshField& field : fields)
    if (field.name == name->second) return std::get_if<std::vector<std::int64_t>>(&field.values);
  return nullptr;
}

std::vector<std::filesystem::path> files_of_pvtu(const std::filesystem::path& path) {
  const std::string content = read_whole_file(path);
  XmlTags tags(path.string(), content);
  std::vector<std::filesystem::path> files;
  while (tags.next()) {
    if (!tags.tag().begins || tags.tag().name != "Piece") continue;
    const std::string name(tags.tag().attribute("Source").value_or(""));
    try {
      files.push_back(nearby_file(path, name, "the piece"));
    } catch (const InputError& error) {
      tags.fail(error.what());
    }
    if (std::count(files.begin(), files.end(), files.back()) > 1)
      tags.fail("the file lists the piece " + in_quotes(name) + " twice; remove one");
  }
  if (files.empty())
    throw InputError(path.string() + ": the file lists no pieces; give one of the .vtu files");
  return files;
}

bool has_no_cells(const std::filesystem::path& path) {
  // Large files need not be read twice.
  constexpr std::uintmax_t most = std::uintmax_t{1} << 20;
  if (std::filesystem::file_size(path) > most) return false;
  const std::string content = read_whole_file(path);
  XmlTags tags(path.string(), content);
  bool has_piece = false;
  while (tags.next() && tags.tag().name != "AppendedData") {
    if (!tags.tag().begins || tags.tag().name != "Piece") continue;
    if (tags.tag().attribute("NumberOfCells") != "0") return false;
    has_piece = true;
  }
  return has_piece;
}

MeshParts read_vtu(const std::filesystem::path& path, const MeshReadOptions& options) {
  return vtu_parts(path, grid_of_files({path}), options);
}

MeshParts read_pvtu(const std::filesystem::path& path, const MeshReadOptions& options) {
  const auto files = files_of_pvtu(path);
  auto parts = vtu_parts(path, grid_of_files(files), options);
  if (files.size() > 1)
    parts.notes.push_back("the mesh has " + std::to_string(files.size()) +
                          " pieces, which are read as one mesh" + join_pieces(parts));
  return parts;
}

}  // namespace smoothfem
