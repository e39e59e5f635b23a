#include "fem/finite_element_space.h"

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>
#include <deal.II/hp/fe_collection.h>

#include <algorithm>
#include <array>
#include <set>

namespace smoothfem {

namespace {

constexpr unsigned int simplex_index = 0, quadrilateral_index = 1;

/// A triangulation with the mesh's cells in the mesh's order, except that cells may be rotated.
void fill_triangulation(const PlanarMesh& mesh, dealii::Triangulation<2>& triangulation) {
  std::vector<dealii::Point<2>> vertices;
  for (const auto& p : mesh.coordinates()) vertices.emplace_back(p.x(), p.y());
  std::vector<dealii::CellData<2>> cells;
  bool all_quadrilaterals = true;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto nodes = mesh.topology().cell_nodes(c);
    if (nodes.size() > 4)
      throw CellError(c, "has " + std::to_string(nodes.size()) +
                             " nodes; finite elements are solved on triangles and quadrilaterals "
                             "only, so split the polygons first");
    dealii::CellData<2> cell(static_cast<unsigned int>(nodes.size()));
    std::copy(nodes.begin(), nodes.end(), cell.vertices.begin());
    // deal.II lists a quadrilateral's nodes in lexicographic order, not around it.
    if (nodes.size() == 4) std::swap(cell.vertices[2], cell.vertices[3]);
    all_quadrilaterals &= nodes.size() == 4;
    cells.push_back(cell);
  }
  if (all_quadrilaterals) dealii::GridTools::consistently_order_cells(cells);
  triangulation.create_triangulation(vertices, cells, dealii::SubCellData());
}

void number_dofs(dealii::DoFHandler<2>& dofs, const dealii::hp::FECollection<2>& elements) {
  for (const auto& cell : dofs.active_cell_iterators())
    cell->set_active_fe_index(cell->reference_cell().is_simplex() ? simplex_index
                                                                  : quadrilateral_index);
  dofs.distribute_dofs(elements);
}

void read_cells(const dealii::DoFHandler<2>& dofs, FiniteElementSpace& space) {
  std::vector<dealii::types::global_dof_index> indices;
  std::vector<NodeIndex> vertices;
  for (const auto& cell : dofs.active_cell_iterators()) {
    const bool is_triangle = cell->reference_cell().is_simplex();
    indices.resize((is_triangle ? space.triangle : space.quadrilateral).n_dofs);
    cell->get_dof_indices(indices);
    vertices.clear();
    for (const unsigned int v : cell->vertex_indices()) vertices.push_back(cell->vertex_index(v));
    (is_triangle ? space.triangle_cells : space.quadrilateral_cells)
        .push_back(static_cast<std::uint32_t>(space.cell_dofs.size()));
    space.cell_vertices.append(vertices);
    space.cell_dofs.append(indices);
  }
}

/// The nodes around each dof, from any cell that has it; their weights are all the same.
void locate_dofs(FiniteElementSpace& space) {
  std::vector<std::vector<NodeIndex>> nodes(space.n_dofs);
  for (std::size_t c = 0; c < space.cell_dofs.size(); ++c) {
    const auto& element = space.element_of(c);
    for (std::size_t i = 0; i < element.n_dofs; ++i) {
      auto& row = nodes[space.cell_dofs[c][i]];
      if (!row.empty()) continue;
      for (std::size_t v = 0; v < element.n_vertices; ++v)
        if (element.support[i * element.n_vertices + v] > 1e-12)
          row.push_back(space.cell_vertices[c][v]);
      std::sort(row.begin(), row.end());
    }
  }
  for (const auto& row : nodes) space.dof_nodes.append(row);
}

/// Dofs at boundary nodes and, for degree 2, in the middle of boundary edges are not free.
void number_free_dofs(const Topology& topology, FiniteElementSpace& space) {
  std::set<std::array<NodeIndex, 2>> boundary;
  const auto& edges = topology.boundary_facets();
  for (std::size_t e = 0; e < edges.size(); ++e)
    boundary.insert({std::min(edges[e][0], edges[e][1]), std::max(edges[e][0], edges[e][1])});
  space.free_number.assign(space.n_dofs, FiniteElementSpace::absent);
  space.vertex_dof.assign(topology.n_nodes(), FiniteElementSpace::absent);
  for (std::uint32_t dof = 0; dof < space.n_dofs; ++dof) {
    const auto nodes = space.dof_nodes[dof];
    if (nodes.size() == 1) space.vertex_dof[nodes[0]] = dof;
    const bool on_boundary = (nodes.size() == 1 && topology.on_boundary()[nodes[0]]) ||
                             (nodes.size() == 2 && boundary.contains({nodes[0], nodes[1]}));
    if (on_boundary) continue;
    space.free_number[dof] = static_cast<std::uint32_t>(space.free_dofs.size());
    space.free_dofs.push_back(dof);
  }
  space.n_free = space.free_dofs.size();
  if (space.n_free == 0)
    throw InputError(
        "no unknown is left for the finite element solution: every node of the mesh is on its "
        "boundary, so refine the mesh or take degree 2");
}

void build_pattern(FiniteElementSpace& space) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto for_each_pair = [&](const auto& visit) {
    for (std::size_t c = 0; c < space.cell_dofs.size(); ++c)
      for (const std::uint32_t i : space.cell_dofs[c])
        for (const std::uint32_t j : space.cell_dofs[c])
          visit(c, space.free_number[i], space.free_number[j]);
  };
  constexpr auto absent = FiniteElementSpace::absent;
  for_each_pair([&](std::size_t, std::uint32_t i, std::uint32_t j) {
    if (i != absent && j != absent) entries.emplace_back(i, j, 0.0);
  });
  const auto n = static_cast<Eigen::Index>(space.n_free);
  space.pattern.resize(n, n);
  space.pattern.setFromTriplets(entries.begin(), entries.end());

  std::vector<std::size_t> offsets{0};
  std::vector<std::uint32_t> places;
  for (std::size_t c = 0; c < space.cell_dofs.size(); ++c)
    offsets.push_back(offsets.back() + space.cell_dofs[c].size() * space.cell_dofs[c].size());
  places.reserve(offsets.back());
  const int* starts = space.pattern.outerIndexPtr();
  const int* columns = space.pattern.innerIndexPtr();
  for_each_pair([&](std::size_t, std::uint32_t i, std::uint32_t j) {
    places.push_back(i == absent || j == absent
                         ? absent
                         : static_cast<std::uint32_t>(std::lower_bound(columns + starts[i],
                                                                       columns + starts[i + 1],
                                                                       static_cast<int>(j)) -
                                                      columns));
  });
  space.matrix_places = {std::move(offsets), std::move(places)};
}

}  // namespace

std::vector<Point<2>> FiniteElementSpace::dof_points(
    const std::vector<Point<2>>& coordinates) const {
  std::vector<Point<2>> points(n_dofs);
  for (std::size_t dof = 0; dof < n_dofs; ++dof) {
    Point<2> sum = Point<2>::Zero();
    for (const NodeIndex node : dof_nodes[dof]) sum += coordinates[node];
    points[dof] = sum / static_cast<double>(dof_nodes[dof].size());
  }
  return points;
}

std::shared_ptr<const FiniteElementSpace> make_finite_element_space(const PlanarMesh& mesh,
                                                                    int degree,
                                                                    int n_quadrilateral_points) {
  if (degree != 1 && degree != 2)
    throw InputError("finite elements of degree " + std::to_string(degree) +
                     " are not available; choose 1 or 2");
  auto space = std::make_shared<FiniteElementSpace>();
  space->degree = degree;
  space->triangle = make_reference_element(ElementType::triangle, degree, n_quadrilateral_points);
  space->quadrilateral =
      make_reference_element(ElementType::quadrilateral, degree, n_quadrilateral_points);

  dealii::Triangulation<2> triangulation;
  fill_triangulation(mesh, triangulation);
  const dealii::hp::FECollection<2> elements{dealii::FE_SimplexP<2>(degree),
                                             dealii::FE_Q<2>(degree)};
  dealii::DoFHandler<2> dofs(triangulation);
  number_dofs(dofs, elements);
  space->n_dofs = dofs.n_dofs();
  read_cells(dofs, *space);
  locate_dofs(*space);
  number_free_dofs(mesh.topology(), *space);
  build_pattern(*space);
  return space;
}

}  // namespace smoothfem
