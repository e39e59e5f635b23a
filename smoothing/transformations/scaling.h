// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "smoothing/geometry/cell_edges.h"
#include "smoothing/simd/inverse_root.h"

namespace smoothfem {

/// Mean of a cell's nodes: the centre that scaling keeps.
template <class Vector, std::size_t extent>
inline Vector centroid(std::span<const Vector, extent> nodes) {
  auto sum = nodes[0];
  for (std::size_t k = 1; k < nodes.size(); ++k) sum = sum + nodes[k];
  return (1.0 / static_cast<double>(nodes.size())) * sum;
}

/// Sum of the lengths of a polygon's sides.
template <class Corner, std::size_t extent>
inline auto perimeter(std::span<const Corner, extent> polygon) {
  const std::size_t n = polygon.size();
  auto sum = length(polygon[0] - polygon[n - 1]);
  for (std::size_t k = 0; k + 1 < n; ++k) sum += length(polygon[k + 1] - polygon[k]);
  return sum;
}

/// Scales a transformed polygon about the original's centroid, so that it has the original's mean
/// edge length (thesis, Eq. 3.11). The transformation must have kept the centroid.
template <class Corner, std::size_t extent>
inline void keep_mean_edge_length(std::span<const Corner, extent> original,
                                  std::span<Corner, extent> transformed) {
  const auto centre = centroid(original);
  const auto factor = perimeter(original) / perimeter(std::span<const Corner, extent>(transformed));
  for (auto& node : transformed) node = centre + factor * (node - centre);
}

/// Twice the mean area of the triangles that a polygon's nodes form with their neighbours.
template <class Real, std::size_t extent>
inline Real mean_node_triangle(std::span<const Vector2<Real>, extent> polygon) {
  const std::size_t n = polygon.size();
  if (n == 3)
    return cross(polygon[1] - polygon[0],
                 polygon[2] - polygon[0]);  // all three triangles are equal
  Real sum{};
  for (std::size_t k = 0; k < n; ++k)
    sum += cross(polygon[k + 1 == n ? 0 : k + 1] - polygon[k],
                 polygon[k == 0 ? n - 1 : k - 1] - polygon[k]);
  return sum / static_cast<double>(n);
}
/// Twice the mean area for a polygon in space, projected along its mean normal.
template <std::size_t extent>
inline double mean_node_triangle(std::span<const Vector3<double>, extent> polygon) {
  const std::size_t n = polygon.size();
  Vector3<double> sum{};
  for (std::size_t k = 0; k < n; ++k)
    sum = sum + cross(polygon[k + 1 == n ? 0 : k + 1] - polygon[k],
                      polygon[k == 0 ? n - 1 : k - 1] - polygon[k]);
  return length_of_any_size(sum) / static_cast<double>(n);
}

/// Sum of the lengths of a volume cell's edges.
template <class Real, std::size_t n>
inline Real edge_length_sum(const CellEdges<Real, n>& edges) {
  Real sum{};
  unrolled<CellEdges<Real, n>::n_edges>(
      [&](auto e) { sum += square_root(edges.squared_lengths[e]); });
  return sum;
}

/// Sum of six times the volumes of a cell's node simplices (thesis, Section 3.3).
template <class Real, std::size_t n>
inline Real node_simplex_volume_sum(std::span<const Vector3<Real>, n> nodes) {
  Real sum{};
  unrolled<VolumeElement<n>::corners.size()>([&](auto k) {
    constexpr LocalSimplex corner = VolumeElement<n>::corners[k];
    const auto here = nodes[corner[0]];
    sum += determinant(nodes[corner[1]] - here, nodes[corner[2]] - here, nodes[corner[3]] - here);
  });
  return sum;
}

/// Six times the mean volume of a cell's node simplices.
template <class Real, std::size_t n>
inline Real mean_node_tetrahedron(std::span<const Vector3<Real>, n> nodes) {
  return node_simplex_volume_sum(nodes) / static_cast<double>(VolumeElement<n>::corners.size());
}

/// Size of a cell of dimension dim by its mean node simplex.
template <int dim, class Corners>
inline auto node_simplex_size(Corners corners) {
  if constexpr (dim == 2)
    return mean_node_triangle(corners);
  else
    return mean_node_tetrahedron(corners);
}

/// Scales a transformed cell by `factor` and moves it to the original's centroid.
template <class Corner, std::size_t extent, class Real>
inline void scale_about_centroid(std::span<const Corner, extent> original, Real factor,
                                 std::span<Corner, extent> transformed) {
  const auto centre = centroid(original);
  const auto present_centre = centroid(std::span<const Corner, extent>(transformed));
  for (auto& node : transformed) node = centre + factor * (node - present_centre);
}

/// Moves a transformed volume cell to the original's centroid and scales it there to the original's
/// mean edge length (thesis, Eq. 3.11). edges: of `original`.
template <class Real, std::size_t n>
inline void keep_mean_edge_length(std::span<const Vector3<Real>, n> original,
                                  const CellEdges<Real, n>& edges,
                                  std::span<Vector3<Real>, n> transformed) {
  const CellEdges<Real, n> present{std::span<const Vector3<Real>, n>(transformed)};
  scale_about_centroid(original, edge_length_sum(edges) / edge_length_sum(present), transformed);
}

/// Moves a transformed volume cell to the original's centroid and scales it to the original's mean
/// volume of node simplices. That must be positive for both, as for valid cells and their
/// transformed ones.
template <class Real, std::size_t n>
inline void keep_mean_volume(std::span<const Vector3<Real>, n> original,
                             std::span<Vector3<Real>, n> transformed) {
  const Real present = node_simplex_volume_sum(std::span<const Vector3<Real>, n>(transformed));
  scale_about_centroid(original, inverse_root<3>(present / node_simplex_volume_sum(original)),
                       transformed);
}

/// Moves a transformed cell to the original's centroid and scales its mean node simplex to a given
/// size. Both sizes must be positive.
template <int dim, class Corner, std::size_t extent, class Real>
inline void give_size(std::span<const Corner, extent> original, Real size,
                      std::span<Corner, extent> transformed) {
  const Real present = node_simplex_size<dim>(std::span<const Corner, extent>(transformed));
  scale_about_centroid(original, inverse_root<dim>(present / size), transformed);
}

/// Relaxation (1 - rho) original + rho transformed (thesis, Eq. 3.12), rho in (0, 1].
template <class Vector, std::size_t extent>
inline void relax(std::span<const Vector, extent> original, std::span<Vector, extent> transformed,
                  double rho) {
  for (std::size_t k = 0; k < original.size(); ++k)
    transformed[k] = (1.0 - rho) * original[k] + rho * transformed[k];
}

}  // namespace smoothfem
