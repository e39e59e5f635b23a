// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>

#include <limits>
#include <optional>

#include "python/module/bind.h"
#include "python/module/python_mesh.h"
#include "smoothing/surface/surface_constraints.h"

namespace smoothfem {

namespace {

using Coordinates = py::array_t<double, py::array::c_style | py::array::forcecast>;

NodeIndex node_index(std::int64_t number, std::size_t cell) {
  if (number < 0 || number > std::numeric_limits<NodeIndex>::max())
    throw CellError(cell,
                    "has the node number " + std::to_string(number) + "; nodes are counted from 0");
  return static_cast<NodeIndex>(number);
}

/// Converts one row of whole numbers.
void append_row(CompressedRows<NodeIndex>& rows, const std::int64_t* numbers, std::size_t n) {
  std::vector<NodeIndex> row(n);
  for (std::size_t k = 0; k < n; ++k) row[k] = node_index(numbers[k], rows.size());
  rows.append(row);
}

/// Converts a two-dimensional array, or any sequence of sequences.
CompressedRows<NodeIndex> rows_of(const py::object& cells) {
  using Numbers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
  CompressedRows<NodeIndex> rows;
  if (py::isinstance<py::array>(cells)) {
    const auto given = py::cast<py::array>(cells);
    if (given.ndim() == 2 && has_whole_numbers(given)) {
      const Numbers numbers(given);
      const auto size = static_cast<std::size_t>(numbers.shape(1));
      for (py::ssize_t c = 0; c < numbers.shape(0); ++c) append_row(rows, numbers.data(c, 0), size);
      return rows;
    }
  }
  for (const py::handle cell : cells) {
    const auto given = py::array::ensure(cell);
    if (!given || given.ndim() != 1 || !has_whole_numbers(given)) {
      throw CellError(rows.size(), "is not a sequence of whole numbers (node numbers)");
    }
    const Numbers numbers(given);
    append_row(rows, numbers.data(), static_cast<std::size_t>(numbers.size()));
  }
  return rows;
}

template <int spacedim>
std::vector<Point<spacedim>> points_of(const Coordinates& array) {
  std::vector<Point<spacedim>> points(static_cast<std::size_t>(array.shape(0)));
  if (!points.empty()) std::copy_n(array.data(), array.size(), points.data()->data());
  return points;
}

template <int dim>
AnyMesh mesh_of(const Coordinates& points, CompressedRows<NodeIndex> cells,
                std::optional<std::vector<bool>> fixed, MeshLabels labels) {
  const auto n_nodes = static_cast<std::size_t>(points.shape(0));
  return Mesh<dim>(std::make_shared<const Topology>(dim, n_nodes, std::move(cells),
                                                    std::move(fixed), std::move(labels)),
                   points_of<dim>(points));
}

/// midside: rows of midside nodes; None for linear cells.
MeshLabels labels_of(const py::object& midside) {
  MeshLabels labels;
  if (midside.is_none()) return labels;
  MidsideNodes nodes;
  nodes.of_cells = rows_of(midside);
  labels.midside = std::make_shared<const MidsideNodes>(std::move(nodes));
  return labels;
}

bool is_flat(const std::vector<Point<3>>& points) {
  return std::all_of(points.begin(), points.end(),
                     [&](const Point<3>& point) { return point.z() == points.front().z(); });
}

/// Quadrilaterals of meshio have points in space; they would become tetrahedra.
void require_clear_dimension(const CompressedRows<NodeIndex>& rows,
                             const std::vector<Point<3>>& points) {
  if (is_flat(points) && !rows.empty() && rows[0].size() == 4)
    throw InputError(
        "the cells have four nodes, and all points have the same z: give points[:, :2] for planar "
        "quadrilaterals, cell_type=\"quad\" or \"tetra\", dim=2 for a surface, or dim=3");
}

/// Returns the dimension of cells from an argument of Python.
std::optional<int> dimension_of(const py::object& dim) {
  if (dim.is_none()) return std::nullopt;
  const std::string text = py::cast<std::string>(py::str(dim));
  if (!py::isinstance<py::int_>(dim) || (text != "2" && text != "3"))
    throw InputError("dim is the dimension of the cells: 2, or in space 3; it is given as " + text);
  return text == "2" ? 2 : 3;
}

/// cells: rows. dim: as users give it; dim_of_types: that of the types that users name; or None.
/// midside: rows of midside nodes, or None.
PythonMesh make_mesh(const py::object& given, const py::object& rows_given, const py::object& fixed,
                     const py::object& dim, const py::object& dim_of_types,
                     const py::object& midside) {
  const auto points = Coordinates::ensure(given);
  if (!points || points.ndim() != 2 || (points.shape(1) != 2 && points.shape(1) != 3)) {
    PyErr_Clear();
    throw InputError("points is an array of n x 2 or n x 3 numbers");
  }
  const int spacedim = static_cast<int>(points.shape(1));
  const auto asked = dimension_of(dim);
  const auto of_types = dimension_of(dim_of_types);
  if (asked && of_types && *asked != *of_types)
    throw InputError("dim is " + std::to_string(*asked) + ", but the cells have dimension " +
                     std::to_string(*of_types));
  const int cell_dim = asked ? *asked : of_types.value_or(spacedim);
  if (cell_dim > spacedim)
    throw InputError("dim is the dimension of the cells: 2, or in space 3; it is given as " +
                     std::to_string(cell_dim) + ", but points have 2 coordinates");
  auto rows = rows_of(rows_given);
  auto flags = node_flags("fixed", fixed, static_cast<std::size_t>(points.shape(0)));
  if (cell_dim == 3 && !asked && !of_types) require_clear_dimension(rows, points_of<3>(points));
  MeshLabels labels = labels_of(midside);
  if (cell_dim == 3)
    return PythonMesh(mesh_of<3>(points, std::move(rows), std::move(flags), std::move(labels)));
  if (spacedim == 2)
    return PythonMesh(mesh_of<2>(points, std::move(rows), std::move(flags), std::move(labels)));
  // meshio and Gmsh give planar meshes a third coordinate.
  if (of_types && !asked && is_flat(points_of<3>(points)))
    return PythonMesh(
        mesh_of<2>(Coordinates(points[py::make_tuple(py::ellipsis(), py::slice(0, 2, 1))]),
                   std::move(rows), std::move(flags), std::move(labels)));
  return PythonMesh(make_surface_mesh(std::move(rows), points_of<3>(points), std::move(labels),
                                      std::move(flags)));
}

PythonMesh copied(const PythonMesh& mesh) {
  return mesh.visit([](const auto& m) { return PythonMesh(AnyMesh(m)); });
}

std::size_t address(const PythonMesh& mesh) {
  return mesh.visit(
      [](const auto& m) { return reinterpret_cast<std::size_t>(m.coordinates().data()); });
}

std::string description(const PythonMesh& mesh) {
  return mesh.visit([]<int dim, int spacedim>(const Mesh<dim, spacedim>& m) {
    return "<smoothfem.Mesh: " + std::string(mesh_kind_name(dim, spacedim)) + ", " +
           std::to_string(m.n_nodes()) + " nodes, " + std::to_string(m.n_cells()) + " cells>";
  });
}

/// Returns a copy that Python cannot change: changes would not reach the mesh.
template <class Value>
py::array array_of(const std::vector<Value>& values, std::size_t n_rows, std::size_t n_columns) {
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(n_rows)};
  if (n_columns > 1) shape.push_back(static_cast<py::ssize_t>(n_columns));
  py::array_t<Value> array(shape, values.data());
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// The physical tag of each cell, 0 without one.
py::array tags(const PythonMesh& mesh) {
  const Topology& topology = mesh.arrays().topology();
  auto all = topology.labels().cell_tags;
  all.resize(topology.n_cells(), 0);
  return array_of(all, all.size(), 1);
}

/// Name of each reason -> the nodes that stay for it.
py::dict fixed_by_reason(const PythonMesh& mesh) {
  const Topology& topology = mesh.arrays().topology();
  py::dict result;
  for (const auto& [reason, name] : fixed_reasons) {
    std::vector<NodeIndex> nodes;
    for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
      if (has(topology.fixed_reasons(i), reason)) nodes.push_back(i);
    if (!nodes.empty())
      result[py::str(name.data(), name.size())] = array_of(nodes, nodes.size(), 1);
  }
  return result;
}

/// The fields of the file: {"point": {name: values}, "cell": {name: values}}.
py::dict data(const PythonMesh& mesh) {
  const Topology& topology = mesh.arrays().topology();
  const FileContent* content = topology.labels().content.get();
  py::dict of_nodes, of_cells;
  const auto add = [](py::dict& to, const MeshField& field, std::size_t n_rows) {
    std::visit(
        [&](const auto& values) {
          to[py::str(field.name)] = array_of(values, n_rows, field.n_components);
        },
        field.values);
  };
  if (content) {
    for (const MeshField& field : content->node_fields) add(of_nodes, field, topology.n_nodes());
    for (const MeshField& field : content->element_fields) add(of_cells, field, topology.n_cells());
  }
  py::dict result;
  result["point"] = of_nodes;
  result["cell"] = of_cells;
  return result;
}

/// (dimension, tag) -> name.
py::dict names(const PythonMesh& mesh) {
  py::dict result;
  for (const auto& [key, name] : mesh.arrays().topology().labels().names)
    result[py::make_tuple(key.first, key.second)] = name;
  return result;
}

}  // namespace

void bind_mesh(py::module_& module) {
  const auto n_nodes = [](const PythonMesh& m) { return m.arrays().topology().n_nodes(); };
  const auto n_cells = [](const PythonMesh& m) { return m.arrays().topology().n_cells(); };
  const auto spacedim = [](const PythonMesh& m) {
    return m.visit([]<int d, int s>(const Mesh<d, s>&) { return s; });
  };
  const auto kind = [](const PythonMesh& m) {
    return m.visit([]<int d, int s>(const Mesh<d, s>&) { return mesh_kind_name(d, s); });
  };
  py::class_<PythonMesh, std::shared_ptr<PythonMesh>>(
      module, "Mesh", "A mesh with constant cells and variable points.")
      .def(py::init(&make_mesh))
      .def_property(
          "points", [](const py::object& self) { return self.cast<PythonMesh&>().points(self); },
          &PythonMesh::set_points,
          "Coordinates, (n_nodes, spacedim): the memory of the mesh itself, to be read and "
          "written.")
      .def_property_readonly(
          "cells", [](const PythonMesh& m) { return m.arrays().cells(); },
          "Node numbers of each cell: (n_cells, k), or a tuple of arrays if cells differ; "
          "read-only.")
      .def_property_readonly(
          "blocks", [](const PythonMesh& m) { return m.arrays().blocks().attr("copy")(); },
          "Node numbers of the cells of each type: {'triangle': (n, 3), ...}; read-only.")
      .def_property_readonly(
          "cells_dict", [](const PythonMesh& m) { return m.arrays().cells_dict().attr("copy")(); },
          "As blocks, with meshio's names of types: 'triangle', 'quad', 'polygon5', 'tetra', "
          "'pyramid', 'wedge', 'hexahedron'.")
      .def_property_readonly(
          "order", [](const PythonMesh& m) { return m.arrays().topology().midside() ? 2 : 1; },
          "2 if cells have midside nodes, otherwise 1.")
      .def_property_readonly(
          "midside_nodes",
          [](const PythonMesh& m) { return m.arrays().midside_nodes().attr("copy")(); },
          "Other nodes of the cells than their corners, a row for each row of cells_dict; empty "
          "for "
          "linear meshes. Both rows together are those of meshio and VTK: 'tetra' and its 6 nodes "
          "make 'tetra10'.")
      .def_property_readonly(
          "edges", [](const PythonMesh& m) { return m.arrays().edges(); },
          "The ends of each edge, (n_edges, 2), ascending; read-only.")
      .def_property_readonly(
          "node_neighbours", [](const PythonMesh& m) { return m.arrays().node_neighbours(); },
          "(offsets, nodes): an edge joins node i with each of nodes[offsets[i]:offsets[i+1]]; "
          "read-only.")
      .def_property_readonly(
          "boundary_facets",
          [](const PythonMesh& m) { return m.arrays().boundary_facets().attr("copy")(); },
          "Node numbers of the sides (faces) that one cell has alone: {'line': (n, 2)}, or "
          "'triangle', 'quad' of volume meshes; read-only.")
      .def_property_readonly(
          "free", [](const PythonMesh& m) { return m.arrays().free_nodes(); },
          "Numbers of the nodes that smoothing may move, ascending; read-only.")
      .def_property_readonly(
          "fixed", [](const PythonMesh& m) { return m.arrays().fixed_nodes(); },
          "Numbers of the nodes that stay, ascending; read-only.")
      .def_property_readonly("tags", &tags,
                             "Physical tag of each cell, as the file has it; 0 without a tag.")
      .def_property_readonly("names", &names, "Names of physical groups: {(dimension, tag): name}.")
      .def_property_readonly(
          "data", &data,
          "Fields of the file: {'point': {name: values}, 'cell': {name: values}}, with a row for "
          "each node or cell.")
      .def_property_readonly(
          "fixed_reasons", &fixed_by_reason,
          "Why nodes stay: {reason: node numbers}, for example 'boundary', 'interface' or "
          "'required'.")
      .def_property_readonly("n_nodes", n_nodes)
      .def_property_readonly("n_cells", n_cells)
      .def_property_readonly(
          "dim", [](const PythonMesh& m) { return m.arrays().topology().dimension(); },
          "Dimension of the cells: 2 or 3.")
      .def_property_readonly("spacedim", spacedim, "Coordinates of a point: 2 or 3.")
      .def_property_readonly("kind", kind, "'planar', 'volume' or 'surface'.")
      .def("copy", &copied, "Returns a mesh with the same cells and a copy of the points.")
      .def("__copy__", &copied)
      .def("__deepcopy__", [](const PythonMesh& m, const py::dict&) { return copied(m); })
      .def("__repr__", &description);
  module.def("address", &address, py::arg("mesh"), "Address of the coordinates of the mesh.");
}

}  // namespace smoothfem
