// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/space/distributed_mesh.h"

#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria_description.h>

#include "fem/materials/cell_kinds.h"
#include "fem/space/fill_triangulation.h"

namespace smoothfem {

namespace {

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
std::unique_ptr<dealii::Triangulation<dim>> distributed_triangulation(
    const std::function<void(dealii::Triangulation<dim>&)>& fill, const Ranks& ranks) {
  if (ranks.size() == 1) {
    auto triangulation = std::make_unique<dealii::Triangulation<dim>>();
    fill(*triangulation);
    return triangulation;
  }
  const auto n_ranks = static_cast<unsigned int>(ranks.size());
  const auto description =
      dealii::TriangulationDescription::Utilities::create_description_from_triangulation_in_groups<
          dim, dim>(
          fill,
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
template std::unique_ptr<dealii::Triangulation<2>> distributed_triangulation(
    const std::function<void(dealii::Triangulation<2>&)>&, const Ranks&);
template std::unique_ptr<dealii::Triangulation<3>> distributed_triangulation(
    const std::function<void(dealii::Triangulation<3>&)>&, const Ranks&);

template <int dim>
std::unique_ptr<dealii::Triangulation<dim>> make_triangulation(const Mesh<dim>* mesh,
                                                               const Ranks& ranks) {
  return distributed_triangulation<dim>(
      [&](dealii::Triangulation<dim>& whole) {
        fill_triangulation(*mesh, cell_kinds(mesh->topology()), whole);
      },
      ranks);
}
template std::unique_ptr<dealii::Triangulation<2>> make_triangulation(const Mesh<2>*, const Ranks&);
template std::unique_ptr<dealii::Triangulation<3>> make_triangulation(const Mesh<3>*, const Ranks&);

}  // namespace smoothfem
