// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/linear_algebra/conjugate_gradients.h"

namespace smoothfem {

/// An eigenvalue of a Lanczos matrix.
struct RitzValue {
  double value = 0.0;
  /// |A x - value x| / value of the corresponding vector, for an exact Lanczos process. The
  /// distance to the nearest eigenvalue is at most this fraction.
  double residual = 0.0;
};

/// The smallest and the largest Ritz value; matrix: of at least one step.
struct ExtremeRitzValues {
  RitzValue smallest, largest;
};
ExtremeRitzValues extreme_ritz_values(const LanczosMatrix& matrix);

}  // namespace smoothfem
