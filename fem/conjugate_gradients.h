#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/sliced_matrix.h"

namespace smoothfem {

/// What one run of conjugate gradients did.
struct ConjugateGradientsResult {
  std::size_t iterations = 0;
  bool converged = false;
  double seconds = 0.0;
  /// The tridiagonal matrix of the Lanczos process behind the iteration: its extreme eigenvalues
  /// approach those of the (preconditioned) matrix from inside.
  std::vector<double> lanczos_diagonal, lanczos_off_diagonal;
};

enum class Preconditioner { none, jacobi };

/// Solves A x = b from the zero start until |r| <= tolerance |b| in the Euclidean norm of the
/// residual that the recurrence carries, or max_iterations are done. b = 0 gives x = 0.
/// norm_offset: added to |b|^2 in the stopping test only (see PoissonOptions::boundary_in_norm).
ConjugateGradientsResult conjugate_gradients(const SlicedMatrix& matrix, const Eigen::VectorXd& b,
                                             Eigen::VectorXd& x, double tolerance,
                                             std::size_t max_iterations,
                                             Preconditioner preconditioner,
                                             double norm_offset = 0.0);

}  // namespace smoothfem
