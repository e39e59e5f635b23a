// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/bench/stock_path.h"

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/sparse_matrix.h>

#include <chrono>

#include "fem/tests/fe_values_oracle.h"

namespace smoothfem::bench {

namespace {

constexpr int dim = 3;

double seconds_of(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

dealii::AffineConstraints<double> boundary_values(const Oracle<dim>& oracle,
                                                  const std::vector<Point<dim>>& positions,
                                                  const ManufacturedSolution<dim>& solution) {
  dealii::AffineConstraints<double> constraints;
  for (const auto dof : dealii::DoFTools::extract_boundary_dofs(oracle.dofs())) {
    constraints.add_line(dof);
    constraints.set_inhomogeneity(dof, solution.value(positions[dof]));
  }
  constraints.close();
  return constraints;
}

struct System {
  dealii::SparsityPattern pattern;
  dealii::SparseMatrix<double> matrix;
  dealii::Vector<double> right_hand_side, solution;
};

void assemble(const Oracle<dim>& oracle, const dealii::Quadrature<dim>& rule,
              const dealii::AffineConstraints<double>& constraints,
              const ManufacturedSolution<dim>& solution, System& system) {
  dealii::FullMatrix<double> cell_matrix;
  dealii::Vector<double> cell_load;
  oracle.for_each_cell(rule, [&](const dealii::FEValues<dim>& values, const auto& indices) {
    cell_matrix.reinit(indices.size(), indices.size());
    cell_load.reinit(indices.size());
    for (const unsigned int q : values.quadrature_point_indices()) {
      const double f = solution.load(point_from(values.quadrature_point(q)));
      for (const unsigned int i : values.dof_indices()) {
        for (const unsigned int j : values.dof_indices())
          cell_matrix(i, j) += values.shape_grad(i, q) * values.shape_grad(j, q) * values.JxW(q);
        cell_load(i) += values.shape_value(i, q) * f * values.JxW(q);
      }
    }
    constraints.distribute_local_to_global(cell_matrix, cell_load, indices, system.matrix,
                                           system.right_hand_side);
  });
}

}  // namespace

StockTimes solve_by_stock_path(const VolumeMesh& mesh, int degree,
                               const ManufacturedSolution<3>& solution, double tolerance) {
  const Oracle<dim> oracle(mesh, static_cast<unsigned int>(degree));
  // A rule that is exact enough for the matrices on simplices, with smoothfem's number of points on
  // hexahedra.
  dealii::Quadrature<dim> rule = dealii::QGauss<dim>(4);
  if (oracle.simplices()) rule = dealii::QGaussSimplex<dim>(static_cast<unsigned int>(degree) + 1);
  const auto constraints = boundary_values(oracle, oracle.dof_points(), solution);
  System system;
  dealii::DynamicSparsityPattern pattern(oracle.dofs().n_dofs());
  dealii::DoFTools::make_sparsity_pattern(oracle.dofs(), pattern, constraints, false);
  system.pattern.copy_from(pattern);
  system.matrix.reinit(system.pattern);
  system.right_hand_side.reinit(oracle.dofs().n_dofs());
  system.solution.reinit(oracle.dofs().n_dofs());

  StockTimes times;
  times.assembly = seconds_of([&] { assemble(oracle, rule, constraints, solution, system); });
  times.cg = seconds_of([&] {
    dealii::SolverControl control(100000, tolerance * system.right_hand_side.l2_norm());
    dealii::SolverCG<dealii::Vector<double>>(control).solve(
        system.matrix, system.solution, system.right_hand_side, dealii::PreconditionIdentity());
    constraints.distribute(system.solution);
    times.cg_iterations = control.last_step();
  });
  times.errors = seconds_of([&] {
    times.l2_error = oracle.error(solution, system.solution, dealii::VectorTools::L2_norm);
    oracle.error(solution, system.solution, dealii::VectorTools::H1_norm);
  });
  return times;
}

}  // namespace smoothfem::bench
