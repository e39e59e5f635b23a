#pragma once

#include <numbers>

#include "smoothing/loop/parameter.h"
#include "smoothing/transformations/polygon_transformation.h"
#include "smoothing/transformations/scaling.h"

namespace smoothfem {

/// The parameters of a GETMe element step in the plane.
struct PolygonRegularization {
  double lambda;
  double theta_degrees;
  double rho;

  Parameters parameters() {
    constexpr double above_zero = 1e-9;
    return {{"lambda", "subdivision ratio of the polygon sides, in (0, 1) (Section 2.3)", &lambda,
             above_zero, 1.0 - above_zero},
            {"theta", "base angle of the similar triangles in degrees, in (0, 90) (Section 2.3)",
             &theta_degrees, above_zero, 90.0 - above_zero},
            {"rho", "relaxation, in (0, 1]; 1 takes the transformed element as it is (Eq. 3.12)",
             &rho, above_zero, 1.0}};
  }
  PolygonTransformation transformation() const {
    return {lambda, theta_degrees * std::numbers::pi / 180.0};
  }
};

/// The element step of GETMe: transform, keep centroid and mean edge length, relax.
template <class Real, std::size_t extent>
SMOOTHFEM_INLINE void regularize(const PolygonTransformation& transformation, double rho,
                                 std::span<const Vector2<Real>, extent> polygon,
                                 std::span<Vector2<Real>, extent> result) {
  transformation.apply(polygon, result);
  keep_mean_edge_length(polygon, result);
  if (rho != 1.0) relax(polygon, result, rho);
}

}  // namespace smoothfem
