// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "fem/solvers/mesh_solver.h"

namespace smoothfem {

/// Returns the numbers of a symmetric positive definite matrix that a solver hands back: condition
/// numbers, and CG without preconditioner, with Jacobi and with algebraic multigrid. b: right-hand
/// side, with one entry for each row. Needs MPI. Throws SolverFailure if the matrix is not finite,
/// not symmetric, or not positive definite.
std::vector<SolverNumber> matrix_numbers(const Eigen::SparseMatrix<double, Eigen::RowMajor, int>& a,
                                         const Eigen::VectorXd& b);

/// Their descriptions.
std::vector<NumberDescription> descriptions_of_matrix_numbers();

}  // namespace smoothfem
