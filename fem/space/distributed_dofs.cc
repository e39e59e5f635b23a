// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/space/distributed_dofs.h"

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/hp/fe_collection.h>

#include <deque>

#include "fem/space/distributed_mesh.h"

namespace smoothfem {

namespace {

/// Divides this rank's own cells into adjacent parts. Each grows around a cell until it is as large
/// as the inner caches.
template <int dim>
auto cells_part_by_part(const dealii::DoFHandler<dim>& dofs) {
  constexpr std::size_t cells_of_part = 2000;
  using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;
  std::vector<bool> taken(dofs.get_triangulation().n_active_cells(), false);
  std::vector<Cell> order;
  std::deque<Cell> seeds;
  const auto is_free = [&](const Cell& cell) {
    return cell->is_locally_owned() && !taken[cell->active_cell_index()];
  };
  const auto take = [&](const Cell& cell) {
    taken[cell->active_cell_index()] = true;
    order.push_back(cell);
  };
  for (const auto& cell : dofs.active_cell_iterators())
    for (seeds.push_back(cell); !seeds.empty(); seeds.pop_front()) {
      std::size_t next = order.size();
      const std::size_t end = next + cells_of_part;
      if (is_free(seeds.front())) take(seeds.front());
      for (; next < order.size(); ++next)
        for (const unsigned int f : order[next]->face_indices()) {
          if (order[next]->at_boundary(f)) continue;
          const Cell neighbour = order[next]->neighbor(f);
          if (!is_free(neighbour)) continue;
          if (order.size() < end)
            take(neighbour);
          else
            seeds.push_back(neighbour);
        }
    }
  return order;
}

/// Numbers dofs in the order of the parts' cells, so that the parts of a vector in a matrix product
/// stay in the inner caches. The level sets of Cuthill and McKee's algorithm are too wide for that
/// in space: with quadratic tetrahedra, products took twice as long.
template <int dim>
void renumber_part_by_part(dealii::DoFHandler<dim>& dofs) {
  const auto& own = dofs.locally_owned_dofs();
  std::vector<dealii::types::global_dof_index> numbers(own.n_elements(),
                                                       dealii::numbers::invalid_dof_index);
  std::vector<dealii::types::global_dof_index> indices;
  std::size_t n_numbered = 0;
  for (const auto& cell : cells_part_by_part(dofs)) {
    indices.resize(cell->get_fe().n_dofs_per_cell());
    cell->get_dof_indices(indices);
    for (const auto dof : indices) {
      if (!own.is_element(dof)) continue;
      auto& number = numbers[own.index_within_set(dof)];
      if (number == dealii::numbers::invalid_dof_index) number = own.nth_index_in_set(n_numbered++);
    }
  }
  dofs.renumber_dofs(numbers);
}

}  // namespace

template <int dim>
void distribute_dofs(dealii::DoFHandler<dim>& dofs, int degree) {
  const dealii::FE_SimplexP<dim> simplex(degree);
  const dealii::FE_Q<dim> tensor(degree);
  if constexpr (dim == 2) {
    for (const auto& cell : dofs.active_cell_iterators())
      cell->set_active_fe_index(cell->reference_cell().is_simplex() ? simplex_index : tensor_index);
    dofs.distribute_dofs(dealii::hp::FECollection<dim>{simplex, tensor});
  } else {
    if (dofs.get_triangulation().begin_active()->reference_cell().is_simplex())
      dofs.distribute_dofs(simplex);
    else
      dofs.distribute_dofs(tensor);
    renumber_part_by_part(dofs);
  }
}

template void distribute_dofs(dealii::DoFHandler<2>&, int);
template void distribute_dofs(dealii::DoFHandler<3>&, int);

}  // namespace smoothfem
