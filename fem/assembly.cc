// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/assembly.h"

#include "fem/cell_integrals.h"

namespace smoothfem {

namespace {

constexpr auto absent = FiniteElementSpace<2>::absent;

/// Adds a cell's integrals to the equations of this rank that it is part of; `lane`: which of the
/// batch's cells.
template <int dim, std::size_t n_dofs>
void add_cell(const FiniteElementSpace<dim>& space, const ElementCells& group, std::size_t cell,
              const CellIntegrals<n_dofs, Lanes>& integrals, std::size_t lane,
              PoissonSystem& system) {
  const std::uint32_t* dofs = &group.dofs[cell * n_dofs];
  const std::uint32_t* entries = &group.entries[cell * n_dofs * n_dofs];
  double* values = system.matrix.valuePtr();
  const auto add = [&](std::size_t i, std::size_t j, double stiffness) {
    if (dofs[i] >= space.n_own) return;
    const std::uint32_t entry = entries[i * n_dofs + j];
    if (entry != absent)
      values[entry] += stiffness;
    else
      system.right_hand_side[dofs[i]] -= stiffness * system.exact[dofs[j]];
  };
  for (std::size_t i = 0, p = 0; i < n_dofs; ++i) {
    if (dofs[i] < space.n_own) system.right_hand_side[dofs[i]] += integrals.load[i][lane];
    for (std::size_t j = i; j < n_dofs; ++j, ++p) {
      const double stiffness = integrals.stiffness[p][lane];
      add(i, j, stiffness);
      if (i != j) add(j, i, stiffness);
    }
  }
}

/// b_i += integral of f phi_i over the cells of one element.
template <int dim, std::size_t n_dofs, std::size_t n_vertices>
void add_quadrature_load(const FiniteElementSpace<dim>& space, const ElementCells& group,
                         const std::vector<Point<dim>>& x,
                         const ManufacturedSolution<dim>& solution,
                         Eigen::VectorXd& right_hand_side) {
  const QuadratureTable& table = group.element.errors;
  for (std::size_t cell = 0; cell < group.n_cells(); ++cell) {
    const auto vertices = cell_vertices<dim, n_vertices>(group, cell, x);
    for (std::size_t q = 0; q < table.n_points; ++q) {
      const auto mapped = map_point<dim, double>(table, q, vertices);
      const double f = solution.load(point_of(mapped.position)) * mapped.weight;
      for (std::size_t i = 0; i < n_dofs; ++i) {
        const std::uint32_t row = group.dofs[cell * n_dofs + i];
        if (row < space.n_own) right_hand_side[row] += f * table.shape[q * n_dofs + i];
      }
    }
  }
}

}  // namespace

template <int dim>
PoissonSystem make_system(const FiniteElementSpace<dim>& space) {
  return {.matrix = space.pattern,
          .right_hand_side = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space.n_own)),
          .exact = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space.n_local))};
}

template <int dim>
void assemble(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
              const ManufacturedSolution<dim>& solution, Load load, PoissonSystem& system) {
  const auto points = space.dof_points(x);
  Eigen::VectorXd nodal_load = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space.n_local));
  for (std::size_t dof = 0; dof < space.n_local; ++dof) {
    const auto i = static_cast<Eigen::Index>(dof);
    system.exact[i] = solution.value(points[dof]);
    if (load == Load::nodal) nodal_load[i] = solution.load(points[dof]);
  }
  system.matrix.coeffs().setZero();
  system.right_hand_side.setZero();
  system.n_folded_cells = 0;
  for_each_group(space, [&]<std::size_t n_dofs, std::size_t n_vertices>(const ElementCells& group) {
    CellIntegrals<n_dofs, Lanes> integrals;
    for (std::size_t first = 0; first < group.n_cells(); first += n_lanes) {
      const ElementBatch<dim, n_dofs, n_vertices> batch(group, x, nodal_load, first);
      integrals.template compute<dim, n_vertices>(group.element, batch.vertices, batch.load);
      for (std::size_t l = 0; l < batch.size; ++l) {
        add_cell(space, group, batch.cells[l], integrals, l, system);
        if (batch.cells[l] < group.n_own && !(integrals.smallest_determinant[l] > 0.0))
          ++system.n_folded_cells;
      }
    }
    if (load == Load::quadrature)
      add_quadrature_load<dim, n_dofs, n_vertices>(space, group, x, solution,
                                                   system.right_hand_side);
  });
}

#define SMOOTHFEM_INSTANTIATE(dim)                                                       \
  template PoissonSystem make_system(const FiniteElementSpace<dim>&);                    \
  template void assemble(const FiniteElementSpace<dim>&, const std::vector<Point<dim>>&, \
                         const ManufacturedSolution<dim>&, Load, PoissonSystem&);
SMOOTHFEM_INSTANTIATE(2)
SMOOTHFEM_INSTANTIATE(3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
