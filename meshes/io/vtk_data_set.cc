// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtk_data_set.h"

#include <vtkCellData.h>
#include <vtkCellTypes.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

#include "meshes/io/node_order.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

/// What a VTK cell type is here: its dimension and number of nodes (0: any).
struct CellKind {
  int dimension;
  std::size_t n_nodes;
};

std::optional<CellKind> kind_of(int vtk_type) {
  switch (vtk_type) {
    case VTK_VERTEX:
    case VTK_POLY_VERTEX:
      return CellKind{0, 0};
    case VTK_LINE:
      return CellKind{1, 2};
    case VTK_POLY_LINE:
      return CellKind{1, 0};
    case VTK_TRIANGLE:
      return CellKind{2, 3};
    case VTK_QUAD:
    case VTK_PIXEL:
      return CellKind{2, 4};
    case VTK_POLYGON:
      return CellKind{2, 0};
    case VTK_TETRA:
      return CellKind{3, 4};
    case VTK_PYRAMID:
      return CellKind{3, 5};
    case VTK_WEDGE:
      return CellKind{3, 6};
    case VTK_HEXAHEDRON:
    case VTK_VOXEL:
      return CellKind{3, 8};
    default:
      return std::nullopt;
  }
}

/// Six times a prism's volume, roughly: enough for its sign.
double signed_prism_volume(const std::vector<Point<3>>& x, std::span<const NodeIndex> nodes) {
  const Point<3> base = (x[nodes[1]] - x[nodes[0]]).cross(x[nodes[2]] - x[nodes[0]]) +
                        (x[nodes[4]] - x[nodes[3]]).cross(x[nodes[5]] - x[nodes[3]]);
  return base.dot(x[nodes[3]] + x[nodes[4]] + x[nodes[5]] - x[nodes[0]] - x[nodes[1]] -
                  x[nodes[2]]);
}

/// Collects the mesh of a VTK data set; every problem is thrown with the file's path in front.
class DataSetReader {
 public:
  DataSetReader(std::string path, vtkPointSet& data) : path_(std::move(path)), data_(data) {}

  MeshParts parts() {
    read_points();
    read_fixed();
    read_names();
    vtkDataArray* tags = cell_array("physical_tag");
    vtkDataArray* ids = cell_array("cell_id");
    vtkNew<vtkIdList> nodes;
    for (vtkIdType c = 0; c < data_.GetNumberOfCells(); ++c) {
      data_.GetCellPoints(c, nodes);
      const int dimension = add_cell(c, nodes);
      if (dimension == 0) continue;
      ElementList& elements = parts_.elements[dimension];
      if (tags) elements.tags.push_back(static_cast<int>(tags->GetComponent(c, 0)));
      if (ids) elements.ids.push_back(number(ids->GetComponent(c, 0)));
    }
    choose_wedge_order();
    return std::move(parts_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(path_ + ": " + message);
  }

  void read_points() {
    const vtkIdType n = data_.GetNumberOfPoints();
    if (n == 0) fail("the file has no points");
    parts_.coordinates.resize(static_cast<std::size_t>(n));
    for (vtkIdType i = 0; i < n; ++i) data_.GetPoint(i, parts_.coordinates[i].data());
    if (vtkDataArray* ids = array_of(data_.GetPointData(), "node_id", n, "point"))
      for (vtkIdType i = 0; i < n; ++i) parts_.node_ids.push_back(number(ids->GetComponent(i, 0)));
  }

  void read_fixed() {
    const vtkIdType n = data_.GetNumberOfPoints();
    vtkDataArray* fixed = array_of(data_.GetPointData(), "fixed", n, "point");
    if (!fixed) return;
    parts_.fixed.emplace();
    for (vtkIdType i = 0; i < n; ++i) parts_.fixed->push_back(fixed->GetComponent(i, 0) != 0.0);
  }

  /// Lines "dimension tag name" in the field data, as characters.
  void read_names() {
    vtkDataArray* characters = data_.GetFieldData()->GetArray("physical_name");
    if (!characters) return;
    std::string text;
    for (vtkIdType i = 0; i < characters->GetNumberOfTuples(); ++i)
      text += static_cast<char>(characters->GetComponent(i, 0));
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
      if (!add_physical_name(line, parts_))
        fail("the field 'physical_name' has the line '" + line +
             "', which is not 'dimension tag name'");
  }

  vtkDataArray* cell_array(const char* name) const {
    return array_of(data_.GetCellData(), name, data_.GetNumberOfCells(), "cell");
  }

  vtkDataArray* array_of(vtkDataSetAttributes* attributes, const char* name, vtkIdType n,
                         const std::string& kind) const {
    vtkDataArray* array = attributes->GetArray(name);
    if (array && array->GetNumberOfTuples() != n)
      fail("the " + kind + " array '" + name + "' has " +
           std::to_string(array->GetNumberOfTuples()) + " values for " + std::to_string(n) + " " +
           kind + "s");
    return array;
  }

  /// Other programs may keep anything under this name; 0 is no number.
  static std::size_t number(double value) {
    constexpr double largest_exact = 9007199254740992.0;
    return value >= 1.0 && value <= largest_exact ? static_cast<std::size_t>(value) : 0;
  }

  void read_indices(vtkIdType cell, vtkIdList* nodes) {
    row_.clear();
    for (vtkIdType k = 0; k < nodes->GetNumberOfIds(); ++k) {
      const vtkIdType node = nodes->GetId(k);
      if (node < 0 || node >= data_.GetNumberOfPoints())
        fail("cell " + std::to_string(cell) + " names point " + std::to_string(node) +
             ", but the file has only " + std::to_string(data_.GetNumberOfPoints()) + " points");
      row_.push_back(static_cast<NodeIndex>(node));
    }
  }

  [[noreturn]] void refuse_type(vtkIdType cell, int type) const {
    const std::string name = vtkCellTypes::GetClassNameFromTypeId(type);
    const bool curved = name.find("Quadratic") != name.npos || name.find("Order") != name.npos ||
                        name.find("Lagrange") != name.npos || name.find("Bezier") != name.npos;
    fail("cell " + std::to_string(cell) + " has the VTK type " + std::to_string(type) + " (" +
         name + "); " +
         (curved ? "cells with nodes besides their corners cannot be read: save the mesh with "
                   "linear cells"
                 : "only triangles, quadrilaterals, polygons, tetrahedra, pyramids, wedges and "
                   "hexahedra can be read"));
  }

  /// Returns the cell's dimension; 0 for cells that are left out.
  int add_cell(vtkIdType cell, vtkIdList* nodes) {
    const int type = data_.GetCellType(cell);
    const auto kind = kind_of(type);
    if (!kind) refuse_type(cell, type);
    if (kind->dimension == 0 || type == VTK_POLY_LINE) return 0;
    read_indices(cell, nodes);
    if (kind->n_nodes != 0 && row_.size() != kind->n_nodes)
      fail("cell " + std::to_string(cell) + " has " + std::to_string(row_.size()) +
           " nodes, but its type has " + std::to_string(kind->n_nodes));
    if (type == VTK_PIXEL) permute(row_, vtk_pixel);
    if (type == VTK_VOXEL) permute(row_, vtk_voxel);
    parts_.elements[kind->dimension].nodes.append(row_);
    return kind->dimension;
  }

  /// The rows are still as in the file, which is Gmsh's order unless VTK's fits as well or better.
  void choose_wedge_order() {
    auto& cells = parts_.elements[3].nodes;
    std::size_t n_wedges = 0, n_positive = 0;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (cells[c].size() != vtk_wedge.size()) continue;
      ++n_wedges;
      n_positive += signed_prism_volume(parts_.coordinates, cells[c]) > 0.0;
    }
    if (n_wedges == 0 || 2 * n_positive > n_wedges) return;
    CompressedRows<NodeIndex> permuted;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      row_.assign(cells[c].begin(), cells[c].end());
      if (row_.size() == vtk_wedge.size()) permute(row_, vtk_wedge);
      permuted.append(row_);
    }
    cells = std::move(permuted);
  }

  std::string path_;
  vtkPointSet& data_;
  MeshParts parts_;
  std::vector<NodeIndex> row_;
};

}  // namespace

MeshParts parts_of_data_set(const std::string& path, vtkPointSet& data) {
  return DataSetReader(path, data).parts();
}

}  // namespace smoothfem
