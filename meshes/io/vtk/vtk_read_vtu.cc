// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/io/vtk/vtk_files.h"
#include "meshes/io/vtk/vtk_grid.h"
#include "meshes/io/vtk/vtu_file.h"

namespace smoothfem {

namespace {

/// Reads the pieces of a file as one grid.
class VtuReader {
 public:
  explicit VtuReader(VtuFile& file) : file_(file) {}

  VtkGrid grid() {
    for (const VtuPiece& piece : file_.pieces()) read_piece(piece);
    for (const VtuArray& array : file_.field_data())
      if (array.name == vtk_names_array) read_names(array);
    return std::move(grid_);
  }

 private:
  void read_piece(const VtuPiece& piece) {
    const std::size_t first_point = grid_.points.size();
    if (piece.n_points > 0) read_points(piece);
    if (piece.n_cells > 0) grid_.cells.append(read_cells(piece), first_point);
    read_arrays(piece, "PointData", piece.n_points, is_known_point_array, grid_.point_arrays);
    read_arrays(piece, "CellData", piece.n_cells, is_known_cell_array, grid_.cell_arrays);
  }

  const VtuArray& required(const VtuPiece& piece, const std::string& section,
                           const std::string& name) const {
    if (const VtuArray* array = piece.array(section, name)) return *array;
    file_.fail("an element <Piece> has no array " + (name.empty() ? "" : "'" + name + "' ") +
               "in <" + section + ">; the file is damaged");
  }

  void read_points(const VtuPiece& piece) {
    const VtuArray& array = required(piece, "Points", "");
    if (array.n_components != 3)
      file_.fail(array,
                 "has " + std::to_string(array.n_components) + " components, but points have 3");
    if (piece.n_points > UINT32_MAX) file_.fail(array, "would have too many points");
    Point<3> point;
    Eigen::Index component = 0;
    file_.read<double>(
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
    file_.read<std::int64_t>(
        offsets, piece.n_cells, [&] { cells.offsets.reserve(piece.n_cells + 1); },
        [&](std::int64_t offset) {
          if (offset < cells.offsets.back() || offset > std::numeric_limits<RowOffset>::max())
            file_.fail(offsets, "does not ascend at cell " + std::to_string(cells.size()) +
                                    "; the file is damaged");
          cells.offsets.push_back(static_cast<RowOffset>(offset));
        });
    const VtuArray& nodes = required(piece, "Cells", "connectivity");
    file_.read<std::int64_t>(
        nodes, cells.offsets.back(), [&] { cells.nodes.reserve(cells.offsets.back()); },
        [&](std::int64_t point) {
          if (!cells.add_node(point, piece.n_points))
            file_.fail(cells.missing_point(point, piece.n_points));
        });
    const VtuArray& types = required(piece, "Cells", "types");
    file_.read<std::int64_t>(
        types, piece.n_cells, [&] { cells.types.reserve(piece.n_cells); },
        [&](std::int64_t type) {
          if (type < 0 || type > 255)
            file_.fail(types, "has " + std::to_string(type) + ", which is not a VTK cell type");
          cells.types.push_back(static_cast<std::uint8_t>(type));
        });
    return cells;
  }

  void read_arrays(const VtuPiece& piece, std::string_view section, std::uint64_t n,
                   bool (*is_known_array)(std::string_view), auto& arrays) {
    const auto found = piece.sections.find(section);
    if (found == piece.sections.end()) return;
    for (const VtuArray& array : found->second)
      if (is_known_array(array.name) && piece.array(section, array.name) == &array)
        read_first_components(array, n, arrays[std::string(array.name)]);
  }

  void read_first_components(const VtuArray& array, std::uint64_t n, std::vector<double>& values) {
    if (array.n_components == 0 || std::max(n, array.n_components) > UINT32_MAX)
      file_.fail(array, "would have " + std::to_string(n) + " values of " +
                            std::to_string(array.n_components) + " components");
    std::uint64_t component = 0;
    file_.read<double>(
        array, n * array.n_components, [&] { values.reserve(values.size() + n); },
        [&](double value) {
          if (component == 0) values.push_back(value);
          if (++component == array.n_components) component = 0;
        });
  }

  void read_names(const VtuArray& array) {
    std::vector<double> characters;
    read_first_components(array, array.n_tuples, characters);
    for (const double character : characters) grid_.physical_names += vtk_character(character);
  }

  VtuFile& file_;
  VtkGrid grid_;
};

/// Frees the text before the mesh is made of its parts: large meshes would need more memory.
MeshParts vtu_parts(const std::filesystem::path& path) {
  VtuFile file(path, read_whole_file(path));
  return parts_of_grid(path.string(), VtuReader(file).grid());
}

}  // namespace

MeshParts read_vtu(const std::filesystem::path& path) {
  return vtu_parts(path);
}

}  // namespace smoothfem
