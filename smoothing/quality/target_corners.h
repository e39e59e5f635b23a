// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>

#include "smoothing/quality/cell_targets.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/simd/cells.h"
#include "smoothing/transformations/scaling.h"

/// Corners of cells as methods and qualities see them: where the mesh has targets, mapped so that
/// the target is regular.

namespace smoothfem {

/// A linear map of one cell or of several at a time.
template <int dim, class Real>
struct LinearMap {
  std::array<Real, static_cast<std::size_t>(dim* dim)> m;  ///< by columns

  inline Vector2<Real> operator()(Vector2<Real> v) const {
    return {m[0] * v.x + m[2] * v.y, m[1] * v.x + m[3] * v.y};
  }
  inline Vector3<Real> operator()(Vector3<Real> v) const {
    return {m[0] * v.x + m[3] * v.y + m[6] * v.z, m[1] * v.x + m[4] * v.y + m[7] * v.z,
            m[2] * v.x + m[5] * v.y + m[8] * v.z};
  }
  inline Real determinant() const {
    if constexpr (dim == 2)
      return m[0] * m[3] - m[1] * m[2];
    else
      return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[3] * (m[1] * m[8] - m[2] * m[7]) +
             m[6] * (m[1] * m[5] - m[2] * m[4]);
  }
  LinearMap transposed() const {
    LinearMap result;
    for (std::size_t i = 0; i < dim; ++i)
      for (std::size_t j = 0; j < dim; ++j) result.m[dim * i + j] = m[dim * j + i];
    return result;
  }
};

enum class TargetMap { to_regular, to_target };

template <TargetMap which, int dim>
inline LinearMap<dim, double> linear_map(const CellTargets<dim>& targets, CellIndex cell) {
  return {which == TargetMap::to_regular ? targets.to_regular(cell) : targets.to_target(cell)};
}
template <TargetMap which, int dim>
inline LinearMap<dim, Lanes> linear_map(const CellTargets<dim>& targets,
                                        const std::array<CellIndex, n_lanes>& cells) {
  LinearMap<dim, Lanes> map;
  for (std::size_t l = 0; l < n_lanes; ++l) {
    const auto of_cell = linear_map<which>(targets, cells[l]);
    for (std::size_t i = 0; i < map.m.size(); ++i) map.m[i][l] = of_cell.m[i];
  }
  return map;
}

/// Returns the corners of several cells. targets: null if there are none. coordinates_of(node): by
/// reference.
template <int dim, std::size_t n, class CoordinatesOf>
inline std::array<Vector<dim, Lanes>, n> target_corners(const CellTargets<dim>* targets,
                                                        const CellBatch<n>& batch,
                                                        const CoordinatesOf& coordinates_of) {
  auto corners = batch.template corners_at<dim>(coordinates_of);
  if (targets != nullptr) [[unlikely]] {
    const auto map = linear_map<TargetMap::to_regular>(*targets, batch.cells);
    for (auto& corner : corners) corner = map(corner);
  }
  return corners;
}

/// Returns the quality q of cells with these corners, or 0 if their size is beyond the bound of the
/// targets. corners: where the targets are regular.
template <int dim, class Vector, std::size_t extent, class Real>
inline Real within_size_bound(const CellTargets<dim>* targets,
                              std::span<const Vector, extent> corners, Real q) {
  if (targets == nullptr) return q;
  const Real size = node_simplex_size<dim>(corners);
  const double bound = targets->size_bound();
  return ((size < bound) & (size * bound > 1.0)) ? q : Real{};
}

/// Calls visit(corners) with those of one cell, as with_corners_at does. Cells of surfaces have no
/// targets.
template <int dim, int spacedim, class CoordinatesOf, class Visit>
inline void with_target_corners(const Mesh<dim, spacedim>& mesh, CellIndex cell,
                                const CoordinatesOf& coordinates_of, const Visit& visit) {
  with_corners_at<dim>(mesh.topology().cell_nodes(cell), coordinates_of, [&](auto corners) {
    if constexpr (dim == spacedim)
      if (mesh.targets() != nullptr) [[unlikely]] {
        const auto map = linear_map<TargetMap::to_regular>(*mesh.targets(), cell);
        with_result(corners, [&](auto mapped) {
          for (std::size_t k = 0; k < corners.size(); ++k) mapped[k] = map(corners[k]);
          visit(decltype(corners)(mapped));
        });
        return;
      }
    visit(corners);
  });
}

/// Maps a cell's corners back from where its target is regular, if the mesh has targets.
template <int dim, int spacedim, class Corner, std::size_t extent>
inline void map_to_target(const Mesh<dim, spacedim>& mesh, CellIndex cell,
                          std::span<Corner, extent> corners) {
  if constexpr (dim == spacedim)
    if (mesh.targets() != nullptr) [[unlikely]] {
      const auto map = linear_map<TargetMap::to_target>(*mesh.targets(), cell);
      for (auto& corner : corners) corner = map(corner);
    }
}

/// Returns the mean ratio of a cell with these corners of with_target_corners, or 0 if its size is
/// beyond the bound of the targets.
template <int dim, int spacedim, class Corners>
inline double target_mean_ratio(const Mesh<dim, spacedim>& mesh, CellIndex cell, Corners corners) {
  const double q = mean_ratio(upper_side(mesh, cell), corners);
  if constexpr (dim == spacedim)
    return within_size_bound<dim>(mesh.targets(), corners, q);
  else
    return q;
}

}  // namespace smoothfem
