// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/quality/mean_ratio.h"

namespace smoothfem {

/// A vector that is not zero, divided by its length. The squares are summed from x to z: Eigen's
/// order depends on how it is compiled, and generated meshes have the same bits everywhere.
inline Point<3> unit_vector(const Point<3>& vector) {
  return vector / length(vector_of(vector));
}

}  // namespace smoothfem
