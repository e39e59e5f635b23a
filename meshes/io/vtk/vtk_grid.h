// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "meshes/io/mesh_assembly.h"

namespace smoothfem {

/// Cells as a VTK file lists them.
struct VtkCells {
  std::vector<RowOffset> offsets{0};  ///< of each cell in `nodes`, and their end
  std::vector<NodeIndex> nodes;       ///< all below the number of points
  std::vector<std::uint8_t> types;    ///< VTK's numbers

  std::size_t size() const { return offsets.size() - 1; }

  /// Adds a node unless there is no such point.
  bool add_node(std::int64_t point, std::size_t n_points) {
    if (point < 0 || static_cast<std::uint64_t>(point) >= n_points) return false;
    nodes.push_back(static_cast<NodeIndex>(point));
    return true;
  }
  /// Of the next node: "cell 3 names point 7, but the file has only 5 points".
  std::string missing_point(std::int64_t point, std::size_t n_points) const;

  /// Ends the cell whose nodes have been added. Throws InputError if there are too many.
  void end_cell() {
    require_countable(nodes.size());
    offsets.push_back(static_cast<RowOffset>(nodes.size()));
  }
  /// Behind these, with nodes that are counted from first_point.
  void append(VtkCells other, std::size_t first_point = 0);
};

/// What is read of a VTK file.
struct VtkGrid {
  std::vector<Point<3>> points;
  VtkCells cells;
  /// The first component of the arrays in honoured_point_arrays and honoured_cell_arrays that the
  /// file has.
  std::map<std::string, std::vector<double>, std::less<>> point_arrays, cell_arrays;
  std::string physical_names;  ///< lines "dimension tag name"
};

bool is_honoured_point_array(std::string_view name);
bool is_honoured_cell_array(std::string_view name);
/// Of the field data.
inline constexpr std::string_view vtk_names_array = "physical_name";

/// A character of physical_names as the number that files hold.
inline char vtk_character(double number) {
  return number >= -128.0 && number <= 255.0 ? static_cast<char>(static_cast<int>(number)) : '?';
}

/// The mesh of what is read. Vertices and lines of several edges are left out. Wedges may have
/// Gmsh's order of nodes: the one counts that makes more volumes positive. Throws InputError that
/// begins with the path for cells of other types, and arrays of a wrong length.
MeshParts parts_of_grid(const std::string& path, VtkGrid grid);

}  // namespace smoothfem
