// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>
#include <deal.II/lac/vector.h>

#include <vector>

#include "fem/deal_ii/lagrange_space.h"
#include "fem/linear_algebra/sliced_matrix.h"
#include "fem/solvers/mesh_solver.h"

namespace smoothfem {

/// A symmetric positive definite system with constraints, for matrices of one pattern. Rows of
/// constrained dofs are decoupled from the others. The rows are distributed over the ranks of the
/// space's triangulation, as in deal.II's step-40, and all functions are collective.
class SymmetricSystem {
 public:
  dealii::TrilinosWrappers::SparseMatrix matrix;
  dealii::TrilinosWrappers::MPI::Vector right_hand_side;
  dealii::TrilinosWrappers::MPI::Vector solution;  ///< at the relevant dofs

  /// Makes the pattern; MPI must have been initialized. constrained: the dofs that every later set
  /// of constraints constrains.
  template <int dim>
  SymmetricSystem(const LagrangeSpace<dim>& space,
                  const dealii::AffineConstraints<double>& constrained);

  /// Takes pattern and values of another program's matrix, and its right-hand side, on one rank.
  SymmetricSystem(const SparseMatrix& a, const Eigen::VectorXd& b);

  /// Assembles matrix and right-hand side. integrate: see LagrangeSpace::for_each_integrated_cell.
  template <int dim, class Integrate>
  void assemble(const LagrangeSpace<dim>& space,
                const dealii::AffineConstraints<double>& constraints, const Integrate& integrate) {
    matrix = 0.0;
    right_hand_side = 0.0;
    space.add_integrals(integrate, constraints, matrix, right_hand_side);
    matrix.compress(dealii::VectorOperation::add);
    right_hand_side.compress(dealii::VectorOperation::add);
  }

  /// Solves by CG without preconditioner, with Jacobi and with algebraic multigrid. The last
  /// solution counts. near_null_space: vectors that the matrix without boundary conditions takes to
  /// zero, with this rank's entries, for multigrid; empty: the constants. Returns the columns of
  /// `descriptions`. Throws SolverFailure if the matrix is not positive definite, or if CG does not
  /// converge.
  std::vector<SolverNumber> solve(const dealii::AffineConstraints<double>& constraints,
                                  const std::vector<std::vector<double>>& near_null_space,
                                  double tolerance);

  /// Solves once, with an error far below the discretization error: by factors, or for large
  /// matrices by CG with multigrid. Throws SolverFailure.
  void solve_accurately(const dealii::AffineConstraints<double>& constraints,
                        const std::vector<std::vector<double>>& near_null_space);

  /// Returns a(u_h, u_h) - 2 l(u_h) of the solution; `integrate` as for `assemble`.
  template <int dim, class Integrate>
  double energy(const LagrangeSpace<dim>& space, const Integrate& integrate) const {
    dealii::Vector<double> u, force;
    double energy = 0.0;
    space.for_each_integrated_cell(
        integrate, [&](const auto& cell, const auto& cell_matrix, const auto& cell_load) {
          u.reinit(cell_load.size());
          cell->get_dof_values(solution, u);
          force.reinit(cell_load.size());
          cell_matrix.vmult(force, u);
          force.add(-2.0, cell_load);
          energy += u * force;
        });
    return Ranks(matrix.get_mpi_communicator()).sum(energy);
  }

  /// Returns the number of dofs that are not constrained, of all ranks.
  std::size_t n_free(const dealii::AffineConstraints<double>& constraints) const;

  static std::vector<NumberDescription> descriptions();

 private:
  /// Returns the condition number of the matrix without the constrained dofs. The root computes it.
  double condition_number(const dealii::AffineConstraints<double>& constraints) const;

  std::size_t most_rows_to_factor_ = 0;
  /// On one rank, CG takes a copy of the matrix in deal.II's own format: it is faster, and its sums
  /// have smaller rounding errors. Empty on several ranks.
  dealii::SparsityPattern pattern_;
};

}  // namespace smoothfem
