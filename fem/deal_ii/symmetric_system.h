// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
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

  /// Takes pattern and values of another program's matrix, and its right-hand side.
  void take(const SparseMatrix& a, const Eigen::VectorXd& b);

  /// Solves by CG without preconditioner, with Jacobi and with algebraic multigrid. The last
  /// solution counts. near_null_space: vectors that the matrix without boundary conditions takes to
  /// zero, for multigrid; empty: the constants. Returns the columns of `descriptions`.
  std::vector<SolverNumber> solve(const dealii::AffineConstraints<double>& constraints,
                                  const std::vector<dealii::Vector<double>>& near_null_space,
                                  double tolerance);

  static std::vector<NumberDescription> descriptions();

 private:
  /// Returns the condition number of the matrix without the constrained dofs.
  double condition_number(const dealii::AffineConstraints<double>& constraints) const;

  std::size_t most_rows_to_factor_ = 0;  ///< for the condition number
  dealii::SparsityPattern pattern_;
  /// Made at first use, as it needs MPI.
  std::unique_ptr<dealii::TrilinosWrappers::SparseMatrix> trilinos_;
};

}  // namespace smoothfem
