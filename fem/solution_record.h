// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace smoothfem {

/// A number of a solver that is not this program's solver for Poisson's equation.
struct SolverNumber {
  std::string name;
  double value = 0.0;  ///< NaN: not known
};

/// The finite element numbers of one mesh: a row of the results.
struct SolutionRecord {
  int degree = 0;
  std::size_t n_dofs = 0, n_free = 0;
  double assembly_seconds = 0.0;  ///< of matrix and right-hand side
  double condition_number = 0.0, lambda_min = 0.0, lambda_max = 0.0;
  std::string condition_method;     ///< "none" if it was not requested
  double condition_residual = 0.0;  ///< see ConditionNumber::residual
  /// Of D^-1/2 A D^-1/2 with the diagonal D of A, from the CG run with Jacobi; slightly low.
  double jacobi_condition_number = 0.0;
  std::size_t cg_iterations = 0, jacobi_cg_iterations = 0, amg_cg_iterations = 0;
  double cg_seconds = 0.0, jacobi_cg_seconds = 0.0, amg_setup_seconds = 0.0, amg_cg_seconds = 0.0;
  bool cg_converged = false;
  double e_max = 0.0, e_mean = 0.0, e_l2 = 0.0, e_h1 = 0.0;  ///< protocol of the thesis
  double l2_error = 0.0, h1_error = 0.0;                     ///< true errors by quadrature
  /// The least errors in these norms that a function of the finite element space with the boundary
  /// values of u_h has.
  double l2_best = 0.0, h1_best = 0.0;
  /// Gauss points in each direction of the hexahedron with the highest-order rule; 0 if no rules
  /// were chosen.
  int most_points = 0;
  std::string status;  ///< "ok", or the problem with the numbers
  /// The numbers of another solver (fem/solvers). The fields above, but degree and status, are then
  /// not used.
  std::vector<SolverNumber> numbers{};
};

/// The norms of u - u_h on one cell.
struct ErrorOnCell {
  double l2 = 0.0, h1 = 0.0;
};

}  // namespace smoothfem
