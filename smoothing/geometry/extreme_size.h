// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "smoothing/base/input_error.h"
#include "smoothing/mesh/point.h"

namespace smoothfem {

/// Returns the binary exponent of the points' extent if it is above 2^100 or below 2^-100,
/// otherwise 0. At such sizes products of several lengths overflow or underflow. Scaling by the
/// power of two with the negative exponent gives an extent near 1 without rounding.
template <class PointType>
int extreme_exponent(std::span<const PointType> points) {
  constexpr int ordinary = 100;
  double extent = 0.0;
  for (const PointType& p : points)
    extent = std::max(extent, (p - points.front()).cwiseAbs().maxCoeff());
  if (!(extent > 0.0) || !std::isfinite(extent)) return 0;
  const int exponent = std::ilogb(extent);
  return std::abs(exponent) > ordinary ? exponent : 0;
}

/// Throws InputError for meshes so small that their coordinates have lost digits, or that the sizes
/// of their cells underflow. exponent: the mesh's extreme_exponent.
inline void require_ordinary_numbers(int exponent) {
  constexpr int smallest = -334;  // 1e-100
  if (exponent < smallest)
    throw InputError("the mesh is only about 2^" + std::to_string(exponent) +
                     " wide, so small that sizes of cells underflow; choose a smaller unit of "
                     "length");
}

template <class PointType>
void scale_by_power_of_two(std::span<PointType> points, int exponent) {
  for (PointType& p : points)
    for (double& coordinate : p) coordinate = std::ldexp(coordinate, exponent);
}

/// Returns the points themselves. If their extent is extreme, returns copies in `storage` that are
/// scaled to an extent near 1.
template <class PointType>
std::span<const PointType> at_ordinary_size(std::span<const PointType> points,
                                            std::vector<PointType>& storage) {
  const int exponent = extreme_exponent(points);
  if (exponent == 0) return points;
  storage.assign(points.begin(), points.end());
  scale_by_power_of_two(std::span(storage), -exponent);
  return storage;
}

}  // namespace smoothfem
