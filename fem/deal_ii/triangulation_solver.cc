// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/deal_ii/triangulation_solver.h"

#include <deal.II/base/multithread_info.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <map>

namespace smoothfem {

namespace {

template <int dim>
dealii::Point<dim> point_of(const Point<dim>& p) {
  dealii::Point<dim> point;
  for (int d = 0; d < dim; ++d) point[d] = p[d];
  return point;
}

/// Returns an id of deal.II for a tag.
unsigned int id_of(int tag) {
  if (tag < 0)
    throw InputError("the mesh has the tag " + std::to_string(tag) +
                     ", but deal.II has no ids below 0; give the group another tag");
  return static_cast<unsigned int>(tag);
}

/// deal.II lists the nodes of quadrilaterals and hexahedra in lexicographic order.
bool is_tensor(ElementType type) {
  return type == ElementType::quadrilateral || type == ElementType::hexahedron;
}

/// Returns the tag of a labelled facet by its sorted nodes.
std::map<std::vector<NodeIndex>, int> facet_tags_of(const MeshLabels& labels) {
  std::map<std::vector<NodeIndex>, int> tags;
  for (std::size_t f = 0; f < labels.facets.size(); ++f) {
    std::vector<NodeIndex> nodes(labels.facets[f].begin(), labels.facets[f].end());
    std::sort(nodes.begin(), nodes.end());
    tags.emplace(std::move(nodes), labels.facet_tags[f]);
  }
  return tags;
}

template <int dim>
void set_boundary_ids(const MeshLabels& labels, dealii::Triangulation<dim>& triangulation) {
  const auto tags = facet_tags_of(labels);
  if (tags.empty()) return;
  std::vector<NodeIndex> nodes;
  for (const auto& face : triangulation.active_face_iterators()) {
    if (!face->at_boundary()) continue;
    nodes.clear();
    for (const unsigned int v : face->vertex_indices()) nodes.push_back(face->vertex_index(v));
    std::sort(nodes.begin(), nodes.end());
    if (const auto tag = tags.find(nodes); tag != tags.end())
      face->set_all_boundary_ids(id_of(tag->second));
  }
}

}  // namespace

template <int dim>
std::unique_ptr<dealii::Triangulation<dim>> triangulation_of(const Mesh<dim>& mesh) {
  dealii::MultithreadInfo::set_thread_limit(1);  // studies use the cores for several records
  const Topology& topology = mesh.topology();
  const MeshLabels& labels = topology.labels();
  std::vector<dealii::Point<dim>> vertices;
  for (const auto& p : mesh.coordinates()) vertices.push_back(point_of<dim>(p));
  std::vector<dealii::CellData<dim>> cells;
  bool all_quadrilaterals = dim == 2;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto nodes = topology.cell_nodes(c);
    dealii::CellData<dim> cell(static_cast<unsigned int>(nodes.size()));
    std::copy(nodes.begin(), nodes.end(), cell.vertices.begin());
    const ElementType type = topology.cell_type(c);
    if (type == ElementType::polygon)
      throw InputError("the mesh has a cell with " + std::to_string(nodes.size()) +
                       " nodes, but deal.II has triangles and quadrilaterals only");
    for (std::size_t k = 2; is_tensor(type) && k < nodes.size(); k += 4)
      std::swap(cell.vertices[k], cell.vertices[k + 1]);
    if (type == ElementType::pyramid) std::swap(cell.vertices[2], cell.vertices[3]);
    all_quadrilaterals &= is_tensor(type);
    cell.material_id = labels.cell_tags.empty() ? 0 : id_of(labels.cell_tags[c]);
    cells.push_back(cell);
  }
  if (all_quadrilaterals) dealii::GridTools::consistently_order_cells(cells);
  auto triangulation = std::make_unique<dealii::Triangulation<dim>>();
  triangulation->create_triangulation(vertices, cells, dealii::SubCellData());
  set_boundary_ids(labels, *triangulation);
  return triangulation;
}

template <int dim>
void move_vertices(const Mesh<dim>& mesh, dealii::Triangulation<dim>& triangulation) {
  for (const auto& cell : triangulation.active_cell_iterators())
    for (const unsigned int v : cell->vertex_indices())
      cell->vertex(v) = point_of<dim>(mesh.coordinates()[cell->vertex_index(v)]);
}

template std::unique_ptr<dealii::Triangulation<2>> triangulation_of(const Mesh<2>&);
template std::unique_ptr<dealii::Triangulation<3>> triangulation_of(const Mesh<3>&);
template void move_vertices(const Mesh<2>&, dealii::Triangulation<2>&);
template void move_vertices(const Mesh<3>&, dealii::Triangulation<3>&);

}  // namespace smoothfem
