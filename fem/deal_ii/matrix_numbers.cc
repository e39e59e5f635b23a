// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/solvers/matrix_numbers.h"

#include <cmath>

#include "fem/deal_ii/symmetric_system.h"

namespace smoothfem {

namespace {

constexpr double cg_tolerance = 1e-8;

void require_symmetric(const SparseMatrix& a) {
  constexpr double rounding = 1e-10;  // of the largest entry
  double largest = 0.0;
  for (int k = 0; k < a.nonZeros(); ++k) {
    if (!std::isfinite(a.valuePtr()[k]))
      throw SolverFailure("its matrix has an entry that is not a finite number");
    largest = std::max(largest, std::abs(a.valuePtr()[k]));
  }
  const SparseMatrix difference = a - SparseMatrix(a.transpose());
  for (int k = 0; k < difference.nonZeros(); ++k)
    if (std::abs(difference.valuePtr()[k]) > rounding * largest)
      throw SolverFailure("its matrix is not symmetric, which CG needs");
}

}  // namespace

std::vector<SolverNumber> matrix_numbers(const SparseMatrix& a, const Eigen::VectorXd& b) {
  if (a.rows() != a.cols() || a.rows() != b.size() || a.rows() == 0)
    throw SolverFailure("its matrix has " + std::to_string(a.rows()) + " rows and " +
                        std::to_string(a.cols()) + " columns, and its right-hand side " +
                        std::to_string(b.size()) + " entries; all three have to be the same");
  require_symmetric(a);
  for (int i = 0; i < a.rows(); ++i)
    if (!(a.coeff(i, i) > 0.0) || !std::isfinite(b[i]))
      throw SolverFailure("its matrix has no positive number on the diagonal of row " +
                          std::to_string(i) + ", or its right-hand side no finite one");
  SymmetricSystem system(a, b);
  dealii::AffineConstraints<double> none;
  none.close();
  return system.solve(none, {}, cg_tolerance);
}

std::vector<NumberDescription> descriptions_of_matrix_numbers() {
  return SymmetricSystem::descriptions();
}

}  // namespace smoothfem
