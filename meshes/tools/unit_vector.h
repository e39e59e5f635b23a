// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/quality/mean_ratio.h"

namespace smoothfem {

/// Returns a nonzero vector divided by its length. The squares are summed from x to z: Eigen's
/// order depends on compiler flags, and generated meshes must be bitwise identical everywhere.
inline Point<3> unit_vector(const Point<3>& vector) {
  return vector / length(vector_of(vector));
}

}  // namespace smoothfem
