// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes as arrays in the form of VTK, for the objects of other packages.
#include <pybind11/stl.h>

#include <algorithm>

#include "meshes/io/all_elements.h"
#include "meshes/io/node_order.h"
#include "meshes/io/vtk/vtk_files.h"
#include "meshes/io/vtk/vtk_grid.h"
#include "meshes/io/vtk/vtk_second_order.h"
#include "python/module/bind.h"
#include "python/module/python_mesh.h"
#include "smoothing/mesh/midside_nodes.h"
#include "smoothing/second_order/shape_functions.h"

namespace smoothfem {

namespace {

template <class T>
using Numbers = py::array_t<T, py::array::c_style | py::array::forcecast>;

NumberType number_type_of(const py::array& array, const std::string& name) {
  const char kind = array.dtype().kind();
  const auto size = array.dtype().itemsize();
  const auto of_size = [&](NumberType one, NumberType two, NumberType four, NumberType eight) {
    return size == 1 ? one : size == 2 ? two : size == 4 ? four : eight;
  };
  if (kind == 'f') return size == 4 ? NumberType::float32 : NumberType::float64;
  if (kind == 'i')
    return of_size(NumberType::int8, NumberType::int16, NumberType::int32, NumberType::int64);
  if (kind == 'u' || kind == 'b')
    return of_size(NumberType::uint8, NumberType::uint16, NumberType::uint32, NumberType::uint64);
  throw InputError("the array '" + name + "' has no real numbers; leave it out");
}

MeshField field_of(const std::string& name, const py::handle& given) {
  const auto array = py::array::ensure(given);
  if (!array || array.ndim() < 1)
    throw InputError("'" + name + "' is not an array with one row for each node or cell");
  MeshField field{.name = name};
  field.type = number_type_of(array, name);
  const auto n_rows = static_cast<std::size_t>(array.shape(0));
  field.n_components = n_rows == 0 ? 1 : static_cast<std::size_t>(array.size()) / n_rows;
  if (is_integer(field.type)) {
    const Numbers<std::int64_t> numbers(array);
    field.values = std::vector<std::int64_t>(numbers.data(), numbers.data() + numbers.size());
  } else {
    const Numbers<double> numbers(array);
    field.values = std::vector<double>(numbers.data(), numbers.data() + numbers.size());
  }
  return field;
}

std::vector<MeshField> fields_of(const py::dict& arrays) {
  std::vector<MeshField> fields;
  for (const auto& [name, array] : arrays)
    fields.push_back(field_of(py::cast<std::string>(py::str(name)), array));
  return fields;
}

/// Makes a mesh, and lists what was left out or changed. offsets: of each cell in `nodes`, and
/// their end; types: VTK's numbers.
py::tuple from_grid(const std::string& origin, const Numbers<double>& points,
                    const Numbers<std::int64_t>& offsets, const Numbers<std::int64_t>& nodes,
                    const Numbers<std::uint8_t>& types, const py::dict& point_data,
                    const py::dict& cell_data, const std::string& names,
                    const std::string& tag_field) {
  VtkGrid grid;
  if (points.ndim() != 2 || points.shape(1) < 2 || points.shape(1) > 3)
    throw InputError(origin + ": points is not an array of n x 2 or n x 3 numbers");
  for (py::ssize_t i = 0; i < points.shape(0); ++i)
    grid.points.emplace_back(points.at(i, 0), points.at(i, 1),
                             points.shape(1) == 3 ? points.at(i, 2) : 0.0);
  for (py::ssize_t c = 0; c + 1 < offsets.size(); ++c) {
    for (std::int64_t k = offsets.at(c); k < offsets.at(c + 1); ++k)
      if (!grid.cells.add_node(nodes.at(k), grid.points.size()))
        throw InputError(origin + ": " + grid.cells.missing_point(nodes.at(k), grid.points.size()));
    grid.cells.end_cell();
  }
  grid.cells.types.assign(types.data(), types.data() + types.size());
  grid.point_fields = fields_of(point_data);
  grid.cell_fields = fields_of(cell_data);
  grid.physical_names = names;
  MeshFile file = assemble_mesh(origin, parts_of_grid(origin, std::move(grid), tag_field));
  return py::make_tuple(PythonMesh(std::move(file.mesh)), file.notes);
}

/// Returns a field's values with their type, in some order of the rows.
py::array array_of(const MeshField& field, const std::vector<std::uint32_t>& order) {
  return with_number_type(field.type, [&]<class T>() -> py::array {
    const std::size_t n = field.n_components, n_rows = field.n_rows();
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(n_rows)};
    if (n > 1) shape.push_back(static_cast<py::ssize_t>(n));
    py::array_t<T> array(shape);
    T* to = array.mutable_data();
    std::visit(
        [&](const auto& values) {
          for (std::size_t i = 0; i < n_rows; ++i)
            for (std::size_t k = 0; k < n; ++k)
              *to++ = static_cast<T>(values[(order.empty() ? i : order[i]) * n + k]);
        },
        field.values);
    return array;
  });
}

template <class T>
py::array_t<T> array_of(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// Returns the arrays of a mesh with all its elements: points, offsets, nodes, types, point_data,
/// cell_data, and the name of the array with the tags. Wedges have VTK's order of nodes if
/// vtk_wedges is true.
py::dict to_grid(const PythonMesh& mesh, bool vtk_wedges) {
  return mesh.visit([&](const auto& m) {
    const MeshView view(m);
    const AllElements elements(view);
    const FileContent* content = view.content();
    const auto order = elements.in_file_order(content);
    py::array_t<double> points({static_cast<py::ssize_t>(view.n_nodes()), py::ssize_t{3}});
    for (NodeIndex i = 0; i < view.n_nodes(); ++i)
      for (int d = 0; d < 3; ++d) points.mutable_at(i, d) = view.point(i)[d];
    std::vector<std::int64_t> offsets{0}, nodes;
    std::vector<std::uint8_t> types;
    std::vector<std::int32_t> tags;
    bool has_tags = false;
    for (const std::uint32_t e : order) {
      const int dim = elements.dimension(e);
      const FormatElement* second_order =
          find_type(vtk_quadratic_types, dim, elements.nodes(e).size(), elements.midside(e).size());
      if (!elements.midside(e).empty() && !second_order)
        throw InputError(
            "VTK has no pyramid with 14 nodes; use mesh.points and mesh.midside_nodes");
      const auto row = elements.row(e, second_order ? &second_order->order : nullptr);
      const bool turns = vtk_wedges && !second_order && dim == 3 && row.size() == vtk_wedge.size();
      for (std::size_t k = 0; k < row.size(); ++k) nodes.push_back(row[turns ? vtk_wedge[k] : k]);
      offsets.push_back(static_cast<std::int64_t>(nodes.size()));
      constexpr int vtk_vertex = 1, vtk_line = 3;
      types.push_back(static_cast<std::uint8_t>(second_order ? second_order->number
                                                : dim == 0   ? vtk_vertex
                                                : dim == 1
                                                    ? vtk_line
                                                    : vtk_type(element_type(dim, row.size()))));
      tags.push_back(elements.tag(e));
      has_tags = has_tags || tags.back() != 0;
    }
    py::dict point_data, cell_data, result;
    if (content) {
      for (const MeshField& field : content->node_fields)
        point_data[py::str(field.name)] = array_of(field, {});
      for (const MeshField& field : content->element_fields)
        cell_data[py::str(field.name)] = array_of(field, order);
    }
    std::string tag_field = content ? content->tag_field : "";
    if (tag_field.empty() && has_tags) {
      tag_field = vtk_tag_fields[0];
      cell_data[py::str(tag_field)] = array_of(tags);
    }
    result["points"] = points;
    result["offsets"] = array_of(offsets);
    result["nodes"] = array_of(nodes);
    result["types"] = array_of(types);
    result["point_data"] = point_data;
    result["cell_data"] = cell_data;
    result["tag_field"] = tag_field;
    return result;
  });
}

}  // namespace

namespace {

/// Returns for each cell of second order (meshio's name, VTK's number or 0, dimension, number of
/// corners, positions of its nodes in a row of midside_nodes.h).
py::list types_of_second_order() {
  py::list types;
  const auto add = [&](const FormatElement& type) {
    const auto& [positions, size] = type.order;
    types.append(py::make_tuple(meshio_name(type.dimension, type.n_corners) + std::to_string(size),
                                type.number, type.dimension, type.n_corners,
                                std::vector<int>(positions.begin(), positions.begin() + size)));
  };
  for (const FormatElement& type : vtk_quadratic_types) add(type);
  add(meshio_pyramid_14);
  return types;
}

/// Returns (corners, node) for the midside node of each edge, and in the middle of each face of
/// volume cells and of planar cells; once for each cell.
py::list midside_places(const PythonMesh& mesh) {
  py::list places;
  mesh.visit([&](const auto& m) {
    const Topology& topology = m.topology();
    for (CellIndex c = 0; c < topology.n_cells(); ++c)
      for_each_midside_place(
          topology.dimension(), topology.cell_nodes(c), topology.midside_nodes(c),
          [&](const MidsidePlace& place, NodeIndex node) {
            if (place[0] == place[1]) return;  // in the middle of a hexahedron
            const auto end = std::find(place.begin(), place.end(), no_corner);
            places.append(py::make_tuple(std::vector<NodeIndex>(place.begin(), end), node));
          });
  });
  return places;
}

/// Returns the values of the shape functions of elements with n_nodes nodes at points (n, dim) of
/// their reference domain, (n, n_nodes).
py::array_t<double> shape_values(int dim, std::size_t n_nodes, const Numbers<double>& points) {
  const ShapeFunctions& functions = shape_functions(dim, n_nodes);
  const auto rows = points.unchecked<2>();
  py::array_t<double> result({rows.shape(0), static_cast<py::ssize_t>(n_nodes)});
  auto written = result.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    Point<3> x{};
    for (int d = 0; d < dim; ++d) x[d] = rows(i, d);
    const std::vector<double> values = functions.values(x);
    for (std::size_t k = 0; k < n_nodes; ++k) written(i, static_cast<py::ssize_t>(k)) = values[k];
  }
  return result;
}

}  // namespace

void bind_grids(py::module_& module) {
  module.def("second_order_types", &types_of_second_order);
  module.def("shape_values", &shape_values);
  module.def("midside_places", &midside_places);
  module.def("from_grid", &from_grid);
  module.def("to_grid", &to_grid);
}

}  // namespace smoothfem
