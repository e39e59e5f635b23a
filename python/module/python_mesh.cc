// SPDX-License-Identifier: GPL-3.0-or-later
#include "python/module/python_mesh.h"

#include <map>
#include <string>

#include "meshes/io/vtk/vtk_second_order.h"

namespace smoothfem {

namespace {

using Shape = std::vector<py::ssize_t>;

py::array read_only(py::array array) {
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// Node numbers that belong to the topology, which the array keeps.
py::array view_of(const std::shared_ptr<const Topology>& topology, const NodeIndex* numbers,
                  const Shape& shape) {
  using Owner = std::shared_ptr<const Topology>;
  const py::capsule owner(new Owner(topology), [](void* p) { delete static_cast<Owner*>(p); });
  return read_only(py::array_t<NodeIndex>(shape, numbers, owner));
}

py::array copy_of(const std::vector<NodeIndex>& numbers, const Shape& shape) {
  return read_only(py::array_t<NodeIndex>(shape, numbers.data()));
}

py::ssize_t signed_size(std::size_t n) {
  return static_cast<py::ssize_t>(n);
}

/// The number of nodes that every cell has; 0 if they differ.
std::size_t common_cell_size(const CompressedRows<NodeIndex>& cells) {
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (cells[c].size() != cells[0].size()) return 0;
  return cells.empty() ? 0 : cells[0].size();
}

std::string block_name(int dim, std::size_t n_nodes) {
  const ElementType type = element_type(dim, n_nodes);
  return type == ElementType::polygon ? std::to_string(n_nodes) + "-gon"
                                      : std::string(name_of(type));
}

/// Name of each type of cells -> array, shorter cells first.
using NameOf = std::string (*)(int dim, std::size_t n_nodes);
py::dict by_type(const CompressedRows<NodeIndex>& rows, int dim, NameOf name_of) {
  std::map<std::size_t, std::vector<NodeIndex>> by_size;
  for (std::size_t c = 0; c < rows.size(); ++c)
    by_size[rows[c].size()].insert(by_size[rows[c].size()].end(), rows[c].begin(), rows[c].end());
  py::dict arrays;
  for (const auto& [size, numbers] : by_size)
    arrays[name_of(dim, size).c_str()] =
        copy_of(numbers, {signed_size(numbers.size() / size), signed_size(size)});
  return arrays;
}

}  // namespace

std::string meshio_name(int dim, std::size_t n_nodes) {
  if (dim == 1) return "line";
  switch (element_type(dim, n_nodes)) {
    case ElementType::quadrilateral:
      return "quad";
    case ElementType::polygon:
      return "polygon" + std::to_string(n_nodes);
    case ElementType::tetrahedron:
      return "tetra";
    case ElementType::prism:
      return "wedge";
    default:
      return std::string(name_of(element_type(dim, n_nodes)));
  }
}

const py::object& TopologyArrays::cells() {
  if (cells_) return cells_;
  const auto& rows = topology_->cells();
  if (const std::size_t size = common_cell_size(rows); size > 0) {
    cells_ =
        view_of(topology_, rows.entries().data(), {signed_size(rows.size()), signed_size(size)});
  } else {
    py::tuple arrays(rows.size());
    for (std::size_t c = 0; c < rows.size(); ++c)
      arrays[c] = view_of(topology_, rows[c].data(), {signed_size(rows[c].size())});
    cells_ = arrays;
  }
  return cells_;
}

py::dict TopologyArrays::cells_by_type(std::string (*name)(int, std::size_t)) {
  const auto& rows = topology_->cells();
  const std::size_t size = common_cell_size(rows);
  if (size == 0) return by_type(rows, topology_->dimension(), name);
  py::dict all;
  all[name(topology_->dimension(), size).c_str()] = cells();
  return all;
}

const py::dict& TopologyArrays::blocks() {
  if (blocks_.empty()) blocks_ = cells_by_type(&block_name);
  return blocks_;
}

const py::dict& TopologyArrays::cells_dict() {
  if (cells_dict_.empty()) cells_dict_ = cells_by_type(&meshio_name);
  return cells_dict_;
}

const py::dict& TopologyArrays::midside_nodes() {
  if (!midside_nodes_.empty() || !topology_->midside()) return midside_nodes_;
  const int dim = topology_->dimension();
  std::map<std::size_t, CompressedRows<NodeIndex>> by_corners;
  std::vector<NodeIndex> row;
  for (CellIndex c = 0; c < topology_->n_cells(); ++c) {
    const auto corners = topology_->cell_nodes(c), midside = topology_->midside_nodes(c);
    row.assign(corners.begin(), corners.end());
    row.insert(row.end(), midside.begin(), midside.end());
    if (const FormatElement* type = find_meshio_type(dim, corners.size(), midside.size()))
      type->order.to_file(row);
    by_corners[corners.size()].append(std::span(row).subspan(corners.size()));
  }
  for (const auto& [n_corners, rows] : by_corners) {
    const auto name = meshio_name(dim, n_corners);
    if (const std::size_t size = common_cell_size(rows); size > 0) {
      midside_nodes_[name.c_str()] =
          copy_of(rows.entries(), {signed_size(rows.size()), signed_size(size)});
      continue;
    }
    py::tuple arrays(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      arrays[i] = copy_of({rows[i].begin(), rows[i].end()}, {signed_size(rows[i].size())});
    midside_nodes_[name.c_str()] = arrays;
  }
  return midside_nodes_;
}

const py::array& TopologyArrays::edges() {
  if (edges_) return *edges_;
  std::vector<NodeIndex> ends;
  ends.reserve(2 * topology_->n_edges());
  for (NodeIndex i = 0; i < topology_->n_nodes(); ++i)
    for (const NodeIndex j : topology_->node_neighbours(i))
      if (i < j) ends.insert(ends.end(), {i, j});
  edges_ = copy_of(ends, {signed_size(ends.size() / 2), 2});
  return *edges_;
}

const py::tuple& TopologyArrays::node_neighbours() {
  if (node_neighbours_) return *node_neighbours_;
  std::vector<std::int64_t> offsets{0};
  std::vector<NodeIndex> nodes;
  for (NodeIndex i = 0; i < topology_->n_nodes(); ++i) {
    const auto neighbours = topology_->node_neighbours(i);
    nodes.insert(nodes.end(), neighbours.begin(), neighbours.end());
    offsets.push_back(static_cast<std::int64_t>(nodes.size()));
  }
  node_neighbours_ = py::make_tuple(
      read_only(py::array_t<std::int64_t>(signed_size(offsets.size()), offsets.data())),
      copy_of(nodes, {signed_size(nodes.size())}));
  return *node_neighbours_;
}

const py::dict& TopologyArrays::boundary_facets() {
  if (boundary_facets_.empty())
    boundary_facets_ =
        by_type(topology_->boundary_facets(), topology_->dimension() - 1, &meshio_name);
  return boundary_facets_;
}

const py::array& TopologyArrays::free_nodes() {
  const auto& nodes = topology_->free_nodes();
  if (!free_.size()) free_ = view_of(topology_, nodes.data(), {signed_size(nodes.size())});
  return free_;
}

const py::array& TopologyArrays::fixed_nodes() {
  if (fixed_.size()) return fixed_;
  std::vector<NodeIndex> nodes;
  for (NodeIndex i = 0; i < topology_->n_nodes(); ++i)
    if (topology_->is_fixed(i)) nodes.push_back(i);
  fixed_ = copy_of(nodes, {signed_size(nodes.size())});
  return fixed_;
}

bool has_whole_numbers(const py::array& array) {
  return array.dtype().kind() == 'i' || array.dtype().kind() == 'u';
}

std::optional<std::vector<bool>> node_flags(const std::string& name, const py::object& given,
                                            std::size_t n_nodes) {
  if (given.is_none()) return std::nullopt;
  const auto fixed = py::array::ensure(given);
  const bool is_row = fixed && fixed.ndim() == 1;
  if (is_row && fixed.dtype().kind() == 'b' && static_cast<std::size_t>(fixed.size()) == n_nodes)
    return py::cast<std::vector<bool>>(fixed.attr("tolist")());
  if (!is_row || (!has_whole_numbers(fixed) && fixed.size() > 0))
    throw InputError(name + " is an array of " + std::to_string(n_nodes) +
                     " truth values, one a node, or of the numbers of the fixed nodes");
  std::vector<bool> flags(n_nodes, false);
  for (const py::handle entry : fixed) {
    const auto node = py::cast<std::int64_t>(entry);
    if (node < 0 || static_cast<std::size_t>(node) >= n_nodes)
      throw InputError(name + " has the node number " + std::to_string(node) +
                       ", but the mesh has the nodes 0 to " + std::to_string(n_nodes - 1));
    flags[static_cast<std::size_t>(node)] = true;
  }
  return flags;
}

struct PythonMesh::Kept {
  std::variant<std::monostate, std::vector<Point<2>>, std::vector<Point<3>>> points;
};

PythonMesh::PythonMesh(AnyMesh mesh)
    : own_(std::make_unique<AnyMesh>(std::move(mesh))),
      mesh_(std::visit([](auto& m) { return Reference(&m); }, *own_)),
      arrays_(std::make_shared<TopologyArrays>(
          visit([](const auto& m) { return m.shared_topology(); }))) {}

PythonMesh::PythonMesh(Reference lent, std::shared_ptr<TopologyArrays> arrays, bool writable)
    : mesh_(lent), arrays_(std::move(arrays)), writable_(writable) {}

py::array PythonMesh::points(const py::object& self) {
  return visit([&]<int dim, int spacedim>(Mesh<dim, spacedim>& mesh) -> py::array {
    const Shape shape{signed_size(mesh.n_nodes()), spacedim};
    double* const numbers = mesh.coordinates().data()->data();
    if (!writable_) return read_only(py::array_t<double>(shape, numbers));
    if (own_) return py::array_t<double>(shape, numbers, self);
    if (!kept_) {
      kept_ = new Kept;
      const py::capsule keeper(kept_, [](void* p) { delete static_cast<Kept*>(p); });
      lent_points_ = py::array_t<double>(shape, numbers, keeper);
    }
    return lent_points_;
  });
}

void PythonMesh::set_points(const py::object& points) {
  visit([&]<int dim, int spacedim>(Mesh<dim, spacedim>& mesh) {
    if (!writable_) throw InputError("the points of this mesh are not to be changed here");
    using Coordinates = py::array_t<double, py::array::c_style | py::array::forcecast>;
    const auto numbers = Coordinates::ensure(points);
    if (!numbers || numbers.ndim() != 2 || numbers.shape(0) != signed_size(mesh.n_nodes()) ||
        numbers.shape(1) != spacedim)
      throw InputError("the points of this mesh are an array of " + std::to_string(mesh.n_nodes()) +
                       " x " + std::to_string(spacedim) + " numbers");
    std::vector<Point<spacedim>> copied(mesh.n_nodes());
    std::copy_n(numbers.data(), numbers.size(), copied.data()->data());
    require_finite(copied);
    mesh.set_coordinates(copied);
  });
}

bool PythonMesh::give_back() {
  const bool in_use = kept_ != nullptr && Py_REFCNT(lent_points_.ptr()) > 1;
  if (in_use)
    visit([&]<int dim, int spacedim>(Mesh<dim, spacedim>& mesh) {
      auto points = mesh.copied_coordinates();
      mesh.swap_coordinates(points);
      kept_->points = std::move(points);
    });
  lent_points_ = py::array();
  kept_ = nullptr;
  std::visit([](auto*& mesh) { mesh = nullptr; }, mesh_);
  return in_use;
}

}  // namespace smoothfem
