// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <vector>

#include "fem/linear_algebra/sliced_matrix.h"

namespace smoothfem {

/// The symmetric tridiagonal matrix of the Lanczos process behind conjugate gradients. Its extreme
/// eigenvalues approach those of the (preconditioned) matrix from inside.
struct LanczosMatrix {
  std::vector<double> diagonal;
  std::vector<double> off_diagonal;  ///< same length; the last one leads to the next step
};

enum class ConjugateGradientsEnd { converged, iteration_limit, time_limit, indefinite };

/// Result of one run of conjugate gradients.
struct ConjugateGradientsResult {
  std::size_t iterations = 0;
  ConjugateGradientsEnd end = ConjugateGradientsEnd::converged;
  double seconds = 0.0;
  LanczosMatrix lanczos;
};

struct ConjugateGradientsOptions {
  double tolerance = 1e-8;  ///< for |r| / |b|, with the residual r of the recurrence
  /// Added to |b|^2 in the stopping test only (see PoissonOptions::boundary_in_norm).
  double norm_offset = 0.0;
  std::size_t max_iterations = std::numeric_limits<std::size_t>::max();
  double max_seconds = std::numeric_limits<double>::infinity();
  /// Stops at the first direction p with p . A p <= 0, or residual with r . M^-1 r < 0. Then the
  /// matrix (or the preconditioner) is not positive definite, and the iteration may never end.
  bool stop_if_indefinite = false;
};

/// Computes z = M^-1 r for this rank's entries; collective.
using Preconditioner = std::function<void(const Eigen::VectorXd& r, Eigen::VectorXd& z)>;

/// Returns the division by the diagonal.
Preconditioner jacobi_preconditioner(const SlicedMatrix& matrix);

/// Solves A x = b from the zero start until |r| <= tolerance |b| in the Euclidean norm, or until a
/// limit is reached. b = 0 gives x = 0. preconditioner: empty for none. b: n_rows entries; x gets
/// n_columns entries, including those of other ranks. Collective; all ranks end with the same
/// iteration.
ConjugateGradientsResult conjugate_gradients(const SlicedMatrix& matrix, const Eigen::VectorXd& b,
                                             Eigen::VectorXd& x,
                                             const ConjugateGradientsOptions& options,
                                             const Preconditioner& preconditioner = {});

}  // namespace smoothfem
