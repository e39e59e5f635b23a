// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "meshes/io/mesh_assembly.h"

namespace smoothfem {

/// Cells as listed in a VTK file.
struct VtkCells {
  std::vector<RowOffset> offsets{0};  ///< of each cell in `nodes`, and their end
  std::vector<NodeIndex> nodes;       ///< all below the number of points
  std::vector<std::uint8_t> types;    ///< VTK's numbers

  std::size_t size() const { return offsets.size() - 1; }

  /// Adds a node. Returns false if there is no such point.
  bool add_node(std::int64_t point, std::size_t n_points) {
    if (point < 0 || static_cast<std::uint64_t>(point) >= n_points) return false;
    nodes.push_back(static_cast<NodeIndex>(point));
    return true;
  }
  /// Returns "cell 3 names point 7, but the file has only 5 points" for the next node.
  std::string missing_point(std::int64_t point, std::size_t n_points) const;

  /// Ends the cell whose nodes have been added. Throws InputError if there are too many.
  void end_cell() {
    require_countable(nodes.size());
    offsets.push_back(static_cast<RowOffset>(nodes.size()));
  }
  /// Appends cells with nodes that are counted from first_point.
  void append(VtkCells other, std::size_t first_point = 0);
};

/// Content of a VTK file.
struct VtkGrid {
  std::vector<Point<3>> points;
  VtkCells cells;
  std::vector<MeshField> point_fields, cell_fields, file_fields;
  std::map<std::string, std::string> point_roles, cell_roles;  ///< as in FileContent
  std::string physical_names;                                  ///< lines "dimension tag name"
  bool is_binary = false;
  bool is_polygonal = false;       ///< VTK's POLYDATA
  bool has_unused_points = false;  ///< that the mesh leaves out
  std::vector<std::string> notes;  ///< arrays that are left out, and why
};

/// Name in the field data.
inline constexpr std::string_view vtk_names_array = "physical_name";

/// Converts a number of a file to a character of physical_names.
inline char vtk_character(double number) {
  return number >= -128.0 && number <= 255.0 ? static_cast<char>(static_cast<int>(number)) : '?';
}

/// Makes the parts of a mesh. The arrays 'fixed', 'node_id' and 'cell_id' have their meaning, and
/// so has the array with the tags: `tag_field`, or the first of the file that is in vtk_tag_fields
/// if the name is empty. All other arrays are fields. Lines of several edges are left out. Wedges
/// may have Gmsh's order of nodes: the order that makes more volumes positive is used. Throws
/// InputError that begins with the path for cells of other types, and for arrays of a wrong length.
MeshParts parts_of_grid(const std::string& path, VtkGrid grid, const std::string& tag_field);

/// Dimension and number of nodes (0: any) of a VTK cell type.
struct VtkCellKind {
  int dimension;
  std::size_t n_nodes;
};
/// Returns the kind of a linear cell; nothing for other types.
std::optional<VtkCellKind> vtk_cell_kind(int vtk_type);

/// Approximately six times the volume of a prism with these corners; only its sign is used.
double signed_prism_volume(std::span<const Point<3>, 6> corners);

/// Returns a number of a node or cell. External programs may store anything under this name; 0
/// means none.
std::size_t vtk_id(double value);
/// Returns a tag; 0 if the value is too large for one.
int vtk_tag(double value);

/// Names of arrays with tags of cells, by smoothfem, Gmsh and meshio, deal.II, MFEM, and VTK.
/// Those of the second list have tags of cells of lower dimension, if these are not in the first.
inline constexpr std::array<std::string_view, 8> vtk_tag_fields{
    "physical_tag", "gmsh:physical", "MaterialID",    "material_id",
    "material",     "attribute",     "CellEntityIds", "medit:ref"};
inline constexpr std::array<std::string_view, 2> vtk_boundary_fields{"BoundaryID", "boundary_id"};

/// A role that an array can have for VTK's readers. Legacy files have a keyword for it.
struct VtkRole {
  std::string_view keyword;    ///< of legacy files, in lower case
  std::string_view name;       ///< VTK's, which .vtu files have
  std::uint64_t n_components;  ///< 0: the file says it
};
/// In the order in which VTK writes them.
inline constexpr std::array<VtkRole, 9> vtk_roles{{{"scalars", "Scalars", 0},
                                                   {"vectors", "Vectors", 3},
                                                   {"normals", "Normals", 3},
                                                   {"texture_coordinates", "TCoords", 0},
                                                   {"tensors", "Tensors", 9},
                                                   {"tensors6", "Tensors", 6},
                                                   {"global_ids", "GlobalIds", 1},
                                                   {"pedigree_ids", "PedigreeIds", 1},
                                                   {"edge_flags", "EdgeFlag", 1}}};
/// The role of numbers in the whole mesh.
inline constexpr const char* global_ids_role = "GlobalIds";

/// Returns the values of the field with that role; null if there is no such field of integers.
const std::vector<std::int64_t>* global_ids(const std::map<std::string, std::string>& roles,
                                            const std::vector<MeshField>& fields);

}  // namespace smoothfem
