// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/linear_algebra/conjugate_gradients.h"

namespace smoothfem {

/// An eigenvalue of a Lanczos matrix.
struct RitzValue {
  double value = 0.0;
  /// |A x - value x| / value of the vector that belongs to it, as far as the Lanczos process is
  /// exact: the eigenvalue next to it is no further away than this fraction.
  double residual = 0.0;
};

/// The smallest and the largest one; matrix: of at least one step.
struct ExtremeRitzValues {
  RitzValue smallest, largest;
};
ExtremeRitzValues extreme_ritz_values(const LanczosMatrix& matrix);

}  // namespace smoothfem
