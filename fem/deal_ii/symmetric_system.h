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

  dealii::SparsityPattern pattern_;
  /// Made at first use, as it needs MPI.
  std::unique_ptr<dealii::TrilinosWrappers::SparseMatrix> trilinos_;
};

}  // namespace smoothfem
