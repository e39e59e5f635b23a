// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/plane_of_points.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace smoothfem {

namespace {

constexpr double tolerance = 1e-9;  ///< of the points' extent

/// The plane in which a coordinate is constant up to rounding.
std::optional<PlaneInSpace> along_axes(const std::vector<Point<3>>& points, const Point<3>& low,
                                       const Point<3>& high, double size) {
  for (const Eigen::Index normal : {2, 1, 0}) {
    if (!(high[normal] - low[normal] <= tolerance * size)) continue;
    PlaneInSpace plane;
    plane.x_axis = Point<3>::Unit(normal == 0 ? 1 : 0);
    plane.y_axis = Point<3>::Unit(normal == 2 ? 1 : 2);
    const bool has_zero = low[normal] <= 0.0 && high[normal] >= 0.0;
    plane.origin[normal] = has_zero ? 0.0 : low[normal] + 0.5 * (high[normal] - low[normal]);
    if (high[normal] > low[normal]) plane.initial = points;
    return plane;
  }
  return std::nullopt;
}

}  // namespace

std::optional<PlaneInSpace> plane_of(const std::vector<Point<3>>& points) {
  if (points.empty()) return PlaneInSpace();
  Point<3> low = points.front(), high = low, mean = Point<3>::Zero();
  for (const auto& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const double size = (high - low).norm();
  if (auto plane = along_axes(points, low, high, size)) return plane;
  for (const auto& point : points) mean += (point - low) / static_cast<double>(points.size());
  mean += low;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const auto& point : points) {
    const Point<3> offset = (point - mean) / size;
    spread += offset * offset.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  const Point<3> normal = axes.eigenvectors().col(0);
  const bool lies_in_plane = std::all_of(points.begin(), points.end(), [&](const auto& point) {
    return std::abs((point - mean).dot(normal)) <= tolerance * size;
  });
  if (!lies_in_plane) return std::nullopt;
  // The axes of the coordinate plane that is nearest, turned into this plane.
  Eigen::Index nearest = 0;
  normal.cwiseAbs().maxCoeff(&nearest);
  const Point<3> x = Point<3>::Unit(nearest == 0 ? 1 : 0), y = Point<3>::Unit(nearest == 2 ? 1 : 2);
  PlaneInSpace plane;
  plane.origin = mean;
  plane.x_axis = (x - x.dot(normal) * normal).normalized();
  plane.y_axis = normal.cross(plane.x_axis);
  if (plane.y_axis.dot(y) < 0.0) plane.y_axis = -plane.y_axis;
  plane.initial = points;
  return plane;
}

}  // namespace smoothfem
