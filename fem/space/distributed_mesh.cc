// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/space/distributed_mesh.h"

#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria_description.h>

#include "fem/materials/cell_kinds.h"

namespace smoothfem {

namespace {

/// Makes a triangulation with the mesh's cells in the mesh's order; planar cells may be rotated.
template <int dim>
void fill_triangulation(const Mesh<dim>& mesh, dealii::Triangulation<dim>& triangulation) {
  std::vector<dealii::Point<dim>> vertices;
  for (const auto& p : mesh.coordinates()) {
    vertices.emplace_back();
    for (int d = 0; d < dim; ++d) vertices.back()[d] = p[d];
  }
  const auto kinds = cell_kinds(mesh.topology());
  std::vector<dealii::CellData<dim>> cells;
  bool all_quadrilaterals = dim == 2;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto nodes = mesh.topology().cell_nodes(c);
    dealii::CellData<dim> cell(static_cast<unsigned int>(nodes.size()));
    std::copy(nodes.begin(), nodes.end(), cell.vertices.begin());
    // deal.II lists the nodes of quadrilaterals and hexahedra in lexicographic order.
    const bool tensor = mesh.topology().cell_type(c) == element_types<dim>[tensor_index];
    for (std::size_t k = 2; tensor && k < nodes.size(); k += 4)
      std::swap(cell.vertices[k], cell.vertices[k + 1]);
    all_quadrilaterals &= tensor;
    cell.material_id = kinds[c];
    cells.push_back(cell);
  }
  if (all_quadrilaterals) dealii::GridTools::consistently_order_cells(cells);
  triangulation.create_triangulation(vertices, cells, dealii::SubCellData());
}

/// Stores each vertex' number as its first coordinate before the triangulation is distributed. Each
/// rank renumbers cells and nodes, but a vertex keeps its coordinates.
template <int dim>
void write_numbers_into_vertices(dealii::Triangulation<dim>& triangulation) {
  for (const auto& cell : triangulation.active_cell_iterators())
    for (const unsigned int v : cell->vertex_indices()) {
      dealii::Point<dim> number;
      number[0] = cell->vertex_index(v);
      cell->vertex(v) = number;
    }
}

}  // namespace

template <int dim>
std::unique_ptr<dealii::Triangulation<dim>> make_triangulation(const Mesh<dim>* mesh,
                                                               const Ranks& ranks) {
  if (ranks.size() == 1) {
    auto triangulation = std::make_unique<dealii::Triangulation<dim>>();
    fill_triangulation(*mesh, *triangulation);
    return triangulation;
  }
  const auto n_ranks = static_cast<unsigned int>(ranks.size());
  const auto description =
      dealii::TriangulationDescription::Utilities::create_description_from_triangulation_in_groups<
          dim, dim>([&](dealii::Triangulation<dim>& whole) { fill_triangulation(*mesh, whole); },
                    [&](dealii::Triangulation<dim>& whole, const MPI_Comm&, const unsigned int) {
                      dealii::GridTools::partition_triangulation(n_ranks, whole);
                      write_numbers_into_vertices(whole);
                    },
                    ranks.communicator(), n_ranks);
  auto triangulation = std::make_unique<dealii::parallel::fullydistributed::Triangulation<dim>>(
      ranks.communicator());
  triangulation->create_triangulation(description);
  return triangulation;
}

template std::unique_ptr<dealii::Triangulation<2>> make_triangulation(const Mesh<2>*, const Ranks&);
template std::unique_ptr<dealii::Triangulation<3>> make_triangulation(const Mesh<3>*, const Ranks&);

}  // namespace smoothfem
