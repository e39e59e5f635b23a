// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace smoothfem {

/// Coordinates of a point in the plane (spacedim = 2) or in space (3).
template <int spacedim>
using Point = Eigen::Matrix<double, spacedim, 1>;

/// Returns a . b, added up in the order of the coordinates. The order of Eigen's sums depends on
/// compiler flags.
template <int spacedim>
inline double dot(const Point<spacedim>& a, const Point<spacedim>& b) {
  double sum = a[0] * b[0];
  for (int d = 1; d < spacedim; ++d) sum += a[d] * b[d];
  return sum;
}
template <int spacedim>
inline double squared_length(const Point<spacedim>& a) {
  return dot<spacedim>(a, a);
}

/// Numbers of nodes and cells of a mesh, counted from 0.
using NodeIndex = std::uint32_t;
using CellIndex = std::uint32_t;

}  // namespace smoothfem
