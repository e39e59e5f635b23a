#pragma once

#include <span>

#include "smoothing/mesh/lanes.h"

namespace smoothfem {

/// Mean of a cell's nodes: the centre that scaling keeps.
template <class Real, std::size_t extent>
SMOOTHFEM_INLINE Vector2<Real> centroid(std::span<const Vector2<Real>, extent> nodes) {
  auto sum = nodes[0];
  for (std::size_t k = 1; k < nodes.size(); ++k) sum = sum + nodes[k];
  return (1.0 / static_cast<double>(nodes.size())) * sum;
}

/// Sum of the lengths of a polygon's sides.
template <class Real, std::size_t extent>
SMOOTHFEM_INLINE Real perimeter(std::span<const Vector2<Real>, extent> polygon) {
  const std::size_t n = polygon.size();
  Real sum = length(polygon[0] - polygon[n - 1]);
  for (std::size_t k = 0; k + 1 < n; ++k) sum += length(polygon[k + 1] - polygon[k]);
  return sum;
}

/// Scales a transformed polygon about the original's centroid, which the transformation must have
/// kept, so that it has the original's mean edge length (thesis, Eq. 3.11).
template <class Real, std::size_t extent>
SMOOTHFEM_INLINE void keep_mean_edge_length(std::span<const Vector2<Real>, extent> original,
                                            std::span<Vector2<Real>, extent> transformed) {
  const auto centre = centroid(original);
  const Real factor =
      perimeter(original) / perimeter(std::span<const Vector2<Real>, extent>(transformed));
  for (auto& node : transformed) node = centre + factor * (node - centre);
}

/// Relaxation (1 - rho) original + rho transformed (thesis, Eq. 3.12), rho in (0, 1].
template <class Real, std::size_t extent>
SMOOTHFEM_INLINE void relax(std::span<const Vector2<Real>, extent> original,
                            std::span<Vector2<Real>, extent> transformed, double rho) {
  for (std::size_t k = 0; k < original.size(); ++k)
    transformed[k] = (1.0 - rho) * original[k] + rho * transformed[k];
}

}  // namespace smoothfem
