#pragma once

#include <span>

#include "smoothing/mesh/cell_edges.h"
#include "smoothing/simd/inverse_root.h"
#include "smoothing/simd/lanes.h"

namespace smoothfem {

/// Mean of a cell's nodes: the centre that scaling keeps.
template <class Vector, std::size_t extent>
SMOOTHFEM_INLINE Vector centroid(std::span<const Vector, extent> nodes) {
  auto sum = nodes[0];
  for (std::size_t k = 1; k < nodes.size(); ++k) sum = sum + nodes[k];
  return (1.0 / static_cast<double>(nodes.size())) * sum;
}

/// Sum of the lengths of a polygon's sides.
template <class Corner, std::size_t extent>
SMOOTHFEM_INLINE auto perimeter(std::span<const Corner, extent> polygon) {
  const std::size_t n = polygon.size();
  auto sum = length(polygon[0] - polygon[n - 1]);
  for (std::size_t k = 0; k + 1 < n; ++k) sum += length(polygon[k + 1] - polygon[k]);
  return sum;
}

/// Scales a transformed polygon about the original's centroid, which the transformation must have
/// kept, so that it has the original's mean edge length (thesis, Eq. 3.11).
template <class Corner, std::size_t extent>
SMOOTHFEM_INLINE void keep_mean_edge_length(std::span<const Corner, extent> original,
                                            std::span<Corner, extent> transformed) {
  const auto centre = centroid(original);
  const auto factor = perimeter(original) / perimeter(std::span<const Corner, extent>(transformed));
  for (auto& node : transformed) node = centre + factor * (node - centre);
}

/// Sum of the lengths of a volume cell's edges.
template <class Real, std::size_t n>
SMOOTHFEM_INLINE Real edge_length_sum(const CellEdges<Real, n>& edges) {
  Real sum{};
  unrolled<CellEdges<Real, n>::n_edges>(
      [&](auto e) SMOOTHFEM_INLINE_LAMBDA { sum += square_root(edges.squared_lengths[e]); });
  return sum;
}

/// Sum of six times the volumes of a cell's node simplices (thesis, Section 3.3).
template <class Real, std::size_t n>
SMOOTHFEM_INLINE Real node_simplex_volume_sum(std::span<const Vector3<Real>, n> nodes) {
  Real sum{};
  unrolled<VolumeElement<n>::corners.size()>([&](auto k) SMOOTHFEM_INLINE_LAMBDA {
    constexpr LocalSimplex corner = VolumeElement<n>::corners[k];
    const auto here = nodes[corner[0]];
    sum += determinant(nodes[corner[1]] - here, nodes[corner[2]] - here, nodes[corner[3]] - here);
  });
  return sum;
}

/// What scaling a transformed volume cell keeps.
enum class ScalingRule { mean_edge_length, mean_volume };

/// Moves a transformed cell to the original's centroid and scales it there so that it has the
/// original's mean edge length or mean volume of the node simplices (thesis, Eq. 3.11). The latter
/// needs both to be positive, as those of valid cells and their transformed ones are. edges: of
/// `original`.
template <class Real, std::size_t n>
SMOOTHFEM_INLINE void keep_centroid_and_size(ScalingRule rule,
                                             std::span<const Vector3<Real>, n> original,
                                             const CellEdges<Real, n>& edges,
                                             std::span<Vector3<Real>, n> transformed) {
  const std::span<const Vector3<Real>, n> present(transformed);
  const auto centre = centroid(original), present_centre = centroid(present);
  Real factor;
  if (rule == ScalingRule::mean_edge_length) {
    factor = edge_length_sum(edges) / edge_length_sum(CellEdges<Real, n>(present));
  } else {
    factor = inverse_root<3>(node_simplex_volume_sum(present) / node_simplex_volume_sum(original));
  }
  for (auto& node : transformed) node = centre + factor * (node - present_centre);
}

/// Relaxation (1 - rho) original + rho transformed (thesis, Eq. 3.12), rho in (0, 1].
template <class Vector, std::size_t extent>
SMOOTHFEM_INLINE void relax(std::span<const Vector, extent> original,
                            std::span<Vector, extent> transformed, double rho) {
  for (std::size_t k = 0; k < original.size(); ++k)
    transformed[k] = (1.0 - rho) * original[k] + rho * transformed[k];
}

}  // namespace smoothfem
