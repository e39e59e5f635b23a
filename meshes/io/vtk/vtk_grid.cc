// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtk/vtk_grid.h"

#include <vtkCellType.h>
#include <vtkCellTypes.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <sstream>
#include <utility>

#include "meshes/io/line_reader.h"
#include "meshes/io/node_order.h"
#include "meshes/io/vtk/vtk_second_order.h"
#include "smoothing/base/input_error.h"
#include "smoothing/base/text.h"

namespace smoothfem {

void VtkCells::append(VtkCells other, std::size_t first_point) {
  if (size() == 0 && first_point == 0) {
    *this = std::move(other);
    return;
  }
  const std::size_t first = nodes.size();
  for (const NodeIndex node : other.nodes)
    nodes.push_back(static_cast<NodeIndex>(first_point + node));
  require_countable(nodes.size());
  for (std::size_t c = 1; c < other.offsets.size(); ++c)
    offsets.push_back(static_cast<RowOffset>(first + other.offsets[c]));
  types.insert(types.end(), other.types.begin(), other.types.end());
}

std::string VtkCells::missing_point(std::int64_t point, std::size_t n_points) const {
  // All offsets may be read before the nodes.
  const auto next = std::upper_bound(offsets.begin(), offsets.end(), nodes.size());
  return "cell " + std::to_string(next - offsets.begin() - 1) + " names point " +
         std::to_string(point) + ", but the file has only " + std::to_string(n_points) + " points";
}

std::optional<VtkCellKind> vtk_cell_kind(int vtk_type) {
  switch (vtk_type) {
    case VTK_POLY_VERTEX:
    case VTK_POLY_LINE:
      return VtkCellKind{0, 0};  // left out
    case VTK_VERTEX:
      return VtkCellKind{0, 1};
    case VTK_LINE:
      return VtkCellKind{1, 2};
    case VTK_TRIANGLE:
      return VtkCellKind{2, 3};
    case VTK_QUAD:
    case VTK_PIXEL:
      return VtkCellKind{2, 4};
    case VTK_POLYGON:
      return VtkCellKind{2, 0};
    case VTK_TETRA:
      return VtkCellKind{3, 4};
    case VTK_PYRAMID:
      return VtkCellKind{3, 5};
    case VTK_WEDGE:
      return VtkCellKind{3, 6};
    case VTK_HEXAHEDRON:
    case VTK_VOXEL:
      return VtkCellKind{3, 8};
    default:
      return std::nullopt;
  }
}

double signed_prism_volume(std::span<const Point<3>, 6> x) {
  const Point<3> base = (x[1] - x[0]).cross(x[2] - x[0]) + (x[4] - x[3]).cross(x[5] - x[3]);
  return base.dot(x[3] + x[4] + x[5] - x[0] - x[1] - x[2]);
}

std::size_t vtk_id(double value) {
  constexpr double largest_exact = 9007199254740992.0;
  return value >= 1.0 && value <= largest_exact ? static_cast<std::size_t>(value) : 0;
}

int vtk_tag(double value) {
  return std::abs(value) <= std::numeric_limits<int>::max() ? static_cast<int>(value) : 0;
}

namespace {

/// Returns the linear kind of cells of any order that have their corners only.
std::optional<VtkCellKind> linear_kind_of(int vtk_type, std::size_t n_nodes) {
  const FormatElement* type = find_type(vtk_lagrange_types, vtk_type);
  if (!type || type->n_corners != n_nodes) return std::nullopt;
  return VtkCellKind{type->dimension, type->n_corners};
}

/// Returns VTK's name of a type. VTK 9.1 itself confuses the names of triangles and quadrilaterals
/// of higher order.
std::string class_name(int vtk_type) {
  switch (vtk_type) {
    case VTK_LAGRANGE_TRIANGLE:
      return "vtkLagrangeTriangle";
    case VTK_LAGRANGE_QUADRILATERAL:
      return "vtkLagrangeQuadrilateral";
    case VTK_BEZIER_TRIANGLE:
      return "vtkBezierTriangle";
    case VTK_BEZIER_QUADRILATERAL:
      return "vtkBezierQuadrilateral";
    default:
      return vtkCellTypes::GetClassNameFromTypeId(vtk_type);
  }
}

bool is_wedge(int vtk_type) {
  constexpr std::array wedges{VTK_WEDGE, VTK_QUADRATIC_WEDGE, VTK_BIQUADRATIC_QUADRATIC_WEDGE,
                              VTK_LAGRANGE_WEDGE};
  return std::find(wedges.begin(), wedges.end(), vtk_type) != wedges.end();
}

/// Makes the parts of a grid and consumes it.
class GridParts {
 public:
  GridParts(const std::string& path, VtkGrid& grid, const std::string& tag_field)
      : path_(path), tag_field_(tag_field), grid_(grid), cells_(grid.cells) {}

  MeshParts make() {
    if (grid_.points.empty()) fail("the file has no points");
    if (cells_.size() == 0)
      fail(grid_.has_unused_points
               ? "all cells are ghosts, which another piece has; remove the file from the list"
               : "the file has no cells; it is not a mesh or is truncated");
    if (cells_.types.size() != cells_.size())
      fail("the file has " + std::to_string(cells_.size()) + " cells but " +
           std::to_string(cells_.types.size()) + " cell types; it is truncated or damaged");
    std::array<std::size_t, 4> n_cells{};
    for (std::size_t c = 0; c < cells_.size(); ++c) ++n_cells[check_cell(c)];
    choose_wedge_orders();
    choose_hexahedron_order();
    read_point_arrays();
    read_names();
    divide(n_cells);
    parts_.coordinates = std::move(grid_.points);
    parts_.content.node_fields = std::move(grid_.point_fields);
    parts_.content.element_fields = std::move(grid_.cell_fields);
    parts_.content.file_fields = std::move(grid_.file_fields);
    parts_.content.node_roles = std::move(grid_.point_roles);
    parts_.content.element_roles = std::move(grid_.cell_roles);
    parts_.content.is_binary = grid_.is_binary;
    add_notes_on_types();
    parts_.leaves_out_unused_nodes = grid_.has_unused_points;
    parts_.notes.insert(parts_.notes.end(), grid_.notes.begin(), grid_.notes.end());
    return std::move(parts_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(path_ + ": " + message);
  }

  std::span<NodeIndex> nodes_of(std::size_t cell) {
    return std::span(cells_.nodes)
        .subspan(cells_.offsets[cell], cells_.offsets[cell + 1] - cells_.offsets[cell]);
  }

  [[noreturn]] void refuse_type(std::size_t cell, int type) {
    const std::string name = class_name(type);
    const bool curved = name.find("Quadratic") != name.npos || name.find("Order") != name.npos ||
                        name.find("Lagrange") != name.npos || name.find("Bezier") != name.npos;
    fail("cell " + std::to_string(cell) + " has the VTK type " + std::to_string(type) + " (" +
         name + ") with " + std::to_string(nodes_of(cell).size()) + " nodes; " +
         (curved ? "cells of this type or order cannot be read: save the mesh with linear or "
                   "quadratic cells"
                 : "only triangles, quadrilaterals, polygons, tetrahedra, pyramids, wedges and "
                   "hexahedra can be read"));
  }

  /// Changes the nodes to the order of midside_nodes.h, except for the corners of wedges. Returns
  /// the cell's dimension, also 0 for cells that are left out.
  std::size_t check_cell(std::size_t cell) {
    const int type = cells_.types[cell];
    const auto nodes = nodes_of(cell);
    if (const FormatElement* found = find_vtk_type(type, nodes.size())) {
      is_second_order_ = true;
      found->order.from_file(nodes);
      return static_cast<std::size_t>(found->dimension);
    }
    auto kind = vtk_cell_kind(type);
    if (!kind) kind = linear_kind_of(type, nodes.size());
    if (!kind) refuse_type(cell, type);
    if (kind->n_nodes != 0 && nodes.size() != kind->n_nodes)
      fail("cell " + std::to_string(cell) + " has " + std::to_string(nodes.size()) +
           " nodes, but its type has " + std::to_string(kind->n_nodes));
    if (type == VTK_PIXEL) permute(nodes, vtk_pixel);
    if (type == VTK_VOXEL) permute(nodes, vtk_voxel);
    return static_cast<std::size_t>(kind->dimension);
  }

  /// Returns the number of a cell's corners.
  std::size_t n_corners_of(std::size_t cell) {
    const auto* type = find_vtk_type(cells_.types[cell], nodes_of(cell).size());
    return type ? type->n_corners : nodes_of(cell).size();
  }

  /// Returns the dimension of a cell; -1 if it is left out.
  int dimension_of_cell(std::size_t cell) {
    const int type = cells_.types[cell];
    if (const FormatElement* found = find_vtk_type(type)) return found->dimension;
    const auto kind = vtk_cell_kind(type);
    return kind->dimension == 0 && kind->n_nodes == 0 ? -1 : kind->dimension;
  }

  double prism_volume(std::span<const NodeIndex> nodes) const {
    std::array<Point<3>, 6> x;
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = grid_.points[nodes[k]];
    return signed_prism_volume(x);
  }

  /// Chooses the order of wedges, for each of VTK's types: that of Gmsh unless the one of VTK fits
  /// as well or better.
  void choose_wedge_orders() {
    std::map<int, std::ptrdiff_t> votes;  // for Gmsh's order
    for (std::size_t c = 0; c < cells_.size(); ++c)
      if (is_wedge(cells_.types[c]))
        votes[cells_.types[c]] += prism_volume(nodes_of(c)) > 0.0 ? 1 : -1;
    for (std::size_t c = 0; c < cells_.size() && !votes.empty(); ++c)
      if (is_wedge(cells_.types[c]) && votes[cells_.types[c]] <= 0) {
        const auto midside = reordered_midside(3, nodes_of(c).subspan(6), vtk_wedge);
        permute(nodes_of(c).first(6), vtk_wedge);
        std::ranges::copy(midside, nodes_of(c).begin() + 6);
      }
  }

  /// Chooses the order of two edges of Lagrange hexahedra: each node belongs to the edge whose
  /// middle is nearer.
  void choose_hexahedron_order() {
    double excess = 0.0;  // of distances in the present order
    const auto is_concerned = [&](std::size_t c) {
      return cells_.types[c] == VTK_LAGRANGE_HEXAHEDRON && nodes_of(c).size() > 8;
    };
    const auto [p, q] = vtk_swapped_edges;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      if (!is_concerned(c)) continue;
      const auto x = [&](std::size_t k) { return grid_.points[nodes_of(c)[k]]; };
      const Point<3> of_p = 0.5 * (x(2) + x(6)), of_q = 0.5 * (x(3) + x(7));
      excess +=
          (x(p) - of_p).norm() + (x(q) - of_q).norm() - (x(p) - of_q).norm() - (x(q) - of_p).norm();
    }
    for (std::size_t c = 0; c < cells_.size() && excess > 0.0; ++c)
      if (is_concerned(c)) std::swap(nodes_of(c)[p], nodes_of(c)[q]);
  }

  static auto find(std::vector<MeshField>& fields, std::string_view name) {
    return std::find_if(fields.begin(), fields.end(),
                        [&](const MeshField& field) { return field.name == name; });
  }

  /// Takes the field of a name out of the list. Returns nothing if there is none.
  std::optional<MeshField> take(std::vector<MeshField>& fields, std::string_view name) const {
    const auto found = find(fields, name);
    if (found == fields.end()) return {};
    auto field = std::move(*found);
    fields.erase(found);
    return field;
  }

  void require_rows(const std::vector<MeshField>& fields, std::size_t n,
                    const std::string& kind) const {
    for (const MeshField& field : fields)
      if (field.n_rows() != n)
        fail("the " + kind + " array '" + field.name + "' has " + std::to_string(field.n_rows()) +
             " values for " + std::to_string(n) + " " + kind + "s");
  }

  void read_point_arrays() {
    require_rows(grid_.point_fields, grid_.points.size(), "point");
    if (const auto ids = take(grid_.point_fields, "node_id"))
      for (std::size_t i = 0; i < ids->n_rows(); ++i)
        parts_.node_ids.push_back(vtk_id(ids->number(i * ids->n_components)));
    if (const auto fixed = take(grid_.point_fields, "fixed")) {
      parts_.fixed.emplace();
      for (std::size_t i = 0; i < fixed->n_rows(); ++i)
        parts_.fixed->push_back(fixed->number(i * fixed->n_components) != 0.0);
    }
  }

  /// Adds notes on cells and data sets that are written in another form with the same nodes.
  void add_notes_on_types() {
    const auto has = [&](int type) {
      return std::find(cells_.types.begin(), cells_.types.end(), type) != cells_.types.end();
    };
    if (grid_.is_polygonal)
      parts_.notes.emplace_back("the polygonal data become an unstructured grid");
    if (has(VTK_PIXEL)) parts_.notes.emplace_back("pixels become quadrilaterals");
    if (has(VTK_VOXEL)) parts_.notes.emplace_back("voxels become hexahedra");
    if (std::any_of(cells_.types.begin(), cells_.types.end(),
                    [](int type) { return find_type(vtk_lagrange_types, type) != nullptr; }))
      parts_.notes.emplace_back(
          "Lagrange cells become linear or quadratic cells of the same nodes");
  }

  void read_names() {
    std::istringstream lines(grid_.physical_names);
    for (std::string line; std::getline(lines, line);)
      if (!add_physical_name(line, parts_))
        fail("the field '" + std::string(vtk_names_array) + "' has the line " + in_quotes(line) +
             ", which is not 'dimension tag name'");
  }

  /// Refuses an array that a user takes for tags, but that has other numbers than tags.
  void require_tags(const MeshField& field) const {
    if (field.n_components != 1)
      fail("the cell array '" + field.name + "' has " + std::to_string(field.n_components) +
           " components, but tags are single integers; give another --tag-field");
    for (std::size_t i = 0; i < field.n_rows(); ++i)
      if (const double value = field.number(i); static_cast<double>(vtk_tag(value)) != value)
        fail("the cell array '" + field.name + "' has the number " + number_text(value) +
             ", but tags are integers; give another --tag-field");
  }

  /// Returns the array with the tags, null if there is none.
  const MeshField* tags() {
    auto& fields = grid_.cell_fields;
    if (!tag_field_.empty()) {
      const auto found = find(fields, tag_field_);
      if (found == fields.end())
        fail("the file has no cell array '" + tag_field_ + "'; give another --tag-field");
      require_tags(*found);
      return &*found;
    }
    for (const std::string_view name : vtk_tag_fields)
      if (const auto found = find(fields, name); found != fields.end()) return &*found;
    return nullptr;
  }
  const MeshField* boundary_tags() {
    for (const std::string_view name : vtk_boundary_fields)
      if (const auto found = find(grid_.cell_fields, name); found != grid_.cell_fields.end())
        return &*found;
    return nullptr;
  }

  /// Divides the cells by their dimension.
  void divide(const std::array<std::size_t, 4>& n_cells) {
    const std::size_t n = cells_.size();
    require_rows(grid_.cell_fields, n, "cell");
    const auto ids = take(grid_.cell_fields, "cell_id");
    const MeshField *of_cells = tags(), *of_boundary = boundary_tags();
    const int top = n_cells[3] > 0 ? 3 : 2;
    const auto* only =
        is_second_order_ ? n_cells.end() : std::find(n_cells.begin() + 1, n_cells.end(), n);
    for (std::size_t c = 0; c < n; ++c) {
      const int dimension = dimension_of_cell(c);
      if (dimension < 0) {
        ++n_left_out_;
        continue;
      }
      ElementList& elements = parts_.elements[static_cast<std::size_t>(dimension)];
      if (only == n_cells.end()) elements.append_nodes(nodes_of(c), n_corners_of(c));
      const MeshField* field = of_boundary && dimension < top ? of_boundary : of_cells;
      if (field) elements.tags.push_back(vtk_tag(field->number(c * field->n_components)));
      if (ids) elements.ids.push_back(vtk_id(ids->number(c * ids->n_components)));
      elements.file_positions.push_back(static_cast<std::uint32_t>(c));
    }
    if (only != n_cells.end())  // large meshes are not held twice
      parts_.elements[static_cast<std::size_t>(only - n_cells.begin())].nodes =
          CompressedRows<NodeIndex>(std::move(cells_.offsets), std::move(cells_.nodes));
    if (only != n_cells.end() && grid_.cell_fields.empty())
      parts_.elements[static_cast<std::size_t>(only - n_cells.begin())].file_positions.clear();
    if (n_left_out_ > 0)
      parts_.notes.push_back(std::to_string(n_left_out_) +
                             " lines or vertices of several nodes are left out");
    if (of_cells && of_cells->name != vtk_tag_fields[0]) parts_.content.tag_field = of_cells->name;
    (void)take(grid_.cell_fields, vtk_tag_fields[0]);  // written from the tags
  }

  const std::string& path_;
  const std::string& tag_field_;
  VtkGrid& grid_;
  VtkCells& cells_;
  MeshParts parts_;
  std::size_t n_left_out_ = 0;
  bool is_second_order_ = false;
};

}  // namespace

MeshParts parts_of_grid(const std::string& path, VtkGrid grid, const std::string& tag_field) {
  return GridParts(path, grid, tag_field).make();
}

}  // namespace smoothfem
