// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <memory>
#include <vector>

#include "fem/deal_ii/lagrange_space.h"
#include "fem/linear_algebra/sliced_matrix.h"
#include "fem/solvers/mesh_solver.h"

namespace smoothfem {

/// A symmetric positive definite system with constraints, for matrices of one pattern. Rows of
/// constrained dofs are decoupled from the others.
class SymmetricSystem {
 public:
  dealii::SparseMatrix<double> matrix;
  dealii::Vector<double> right_hand_side, solution;

  /// constrained: the dofs that every later set of constraints constrains.
  template <int dim>
  void reinit(const LagrangeSpace<dim>& space,
              const dealii::AffineConstraints<double>& constrained);

  /// Assembles matrix and right-hand side. integrate(values, cell, cell_matrix, cell_load) adds the
  /// integrals over a cell to zeros (see LagrangeSpace::for_each_cell).
  template <int dim, class Integrate>
  void assemble(const LagrangeSpace<dim>& space,
                const dealii::AffineConstraints<double>& constraints, const Integrate& integrate) {
    matrix = 0.0;
    right_hand_side = 0.0;
    dealii::FullMatrix<double> cell_matrix;
    dealii::Vector<double> cell_load;
    std::vector<dealii::types::global_dof_index> indices;
    space.for_each_cell([&](const dealii::FEValues<dim>& values, const auto& cell) {
      const unsigned int n = values.dofs_per_cell;
      cell_matrix.reinit(n, n);
      cell_load.reinit(n);
      integrate(values, cell, cell_matrix, cell_load);
      indices.resize(n);
      cell->get_dof_indices(indices);
      constraints.distribute_local_to_global(cell_matrix, cell_load, indices, matrix,
                                             right_hand_side);
    });
  }

  /// Takes pattern and values of another program's matrix, and its right-hand side.
  void take(const SparseMatrix& a, const Eigen::VectorXd& b);

  /// Solves by CG without preconditioner, with Jacobi and with algebraic multigrid. The last
  /// solution counts. near_null_space: vectors that the matrix without boundary conditions takes to
  /// zero, for multigrid; empty: the constants. Returns the columns of `descriptions`.
  std::vector<SolverNumber> solve(const dealii::AffineConstraints<double>& constraints,
                                  const std::vector<dealii::Vector<double>>& near_null_space,
                                  double tolerance);

  /// Solves once, with an error far below the discretization error: by factors, or for large
  /// matrices by CG with multigrid. Throws SolverFailure.
  void solve_accurately(const dealii::AffineConstraints<double>& constraints,
                        const std::vector<dealii::Vector<double>>& near_null_space);

  /// Returns a(u_h, u_h) - 2 l(u_h) of the solution; `integrate` as for `assemble`.
  template <int dim, class Integrate>
  double energy(const LagrangeSpace<dim>& space, const Integrate& integrate) const {
    dealii::FullMatrix<double> cell_matrix;
    dealii::Vector<double> cell_load, u, force;
    double energy = 0.0;
    space.for_each_cell([&](const dealii::FEValues<dim>& values, const auto& cell) {
      const unsigned int n = values.dofs_per_cell;
      cell_matrix.reinit(n, n);
      cell_load.reinit(n);
      integrate(values, cell, cell_matrix, cell_load);
      u.reinit(n);
      cell->get_dof_values(solution, u);
      force.reinit(n);
      cell_matrix.vmult(force, u);
      force.add(-2.0, cell_load);
      energy += u * force;
    });
    return energy;
  }

  static std::vector<NumberDescription> descriptions();

 private:
  /// Returns the condition number of the matrix without the constrained dofs.
  double condition_number(const dealii::AffineConstraints<double>& constraints) const;

  dealii::TrilinosWrappers::SparseMatrix& trilinos_matrix();

  std::size_t most_rows_to_factor_ = 0;
  dealii::SparsityPattern pattern_;
  /// Made at first use, as it needs MPI.
  std::unique_ptr<dealii::TrilinosWrappers::SparseMatrix> trilinos_;
};

}  // namespace smoothfem
