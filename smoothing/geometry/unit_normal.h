// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "smoothing/simd/vectors.h"

namespace smoothfem {

/// Unit vector along a polygon's area vector, its mean normal; zero for a polygon without area. The
/// polygon runs counterclockwise when the vector points to the viewer. Three or more corners.
template <std::size_t extent>
inline Vector3<double> unit_normal(std::span<const Vector3<double>, extent> corners) {
  Vector3<double> area{};
  for (std::size_t k = 2; k < corners.size(); ++k)
    area = area + cross(corners[k - 1] - corners[0], corners[k] - corners[0]);
  const double size = length_of_any_size(area);
  return (size > 0.0 ? 1.0 / size : 0.0) * area;
}

}  // namespace smoothfem
