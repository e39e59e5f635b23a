// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <numbers>
#include <span>

#include "smoothing/geometry/cell_edges.h"
#include "smoothing/geometry/unit_normal.h"
#include "smoothing/mesh/node_constraints.h"
#include "smoothing/simd/inverse_root.h"

namespace smoothfem {

/// Sine and cosine of the interior angle of the regular n-gon: they determine the ideal shape of a
/// planar corner.
struct RegularAngle {
  double sine;
  double cosine;
};

/// Returns the interior angle of the regular n-gon, n >= 3. Exact for n = 4, a right angle.
inline RegularAngle regular_interior_angle(std::size_t n) {
  if (n == 4) return {1.0, 0.0};
  if (n == 3) return {0.5 * std::numbers::sqrt3, 0.5};
  const double angle = std::numbers::pi * (static_cast<double>(n) - 2.0) / static_cast<double>(n);
  return {std::sin(angle), std::cos(angle)};
}

/// Mean ratio 2 det(S) / |S|^2 of one corner, S = D W^-1, written out. D has the columns `next` and
/// `previous` (edges from the corner to its neighbours), W those of the regular polygon. In [-1,
/// 1]; positive if and only if det(D) is. Not a number for two edges of length zero. determinant:
/// det(D), the signed area of the edges.
template <class Edge, class Real>
inline Real corner_mean_ratio(Edge next, Edge previous, Real determinant, RegularAngle regular) {
  return 2.0 * regular.sine * determinant /
         (squared_length(next) + squared_length(previous) -
          2.0 * regular.cosine * dot(next, previous));
}

/// Returns 0, the quality of an invalid cell, for a quality that is not a number. Sizes near the
/// limits of floating point give such values.
template <class Real>
inline Real zero_unless_finite(Real quality) {
  return ((quality > 0.0) & (quality < 2.0)) ? quality : Real{};
}

/// Mean of the corner mean ratios of a polygon; 0 if one of them is not positive. determinant(next,
/// previous): the signed area of two edges.
template <class Corner, std::size_t extent, class Determinant>
inline auto polygon_mean_ratio(std::span<const Corner, extent> corners,
                               const Determinant& determinant) {
  using Real = decltype(corners[0].x + 0.0);
  const std::size_t n = corners.size();
  const RegularAngle regular = regular_interior_angle(n);
  if (n == 3) {  // the three corners have the same mean ratio
    const auto next = corners[1] - corners[0], previous = corners[2] - corners[0];
    const Real area = determinant(next, previous);
    return area > 0.0 ? zero_unless_finite(corner_mean_ratio(next, previous, area, regular))
                      : Real{};
  }
  Real sum{}, all_positive = Real{} + 1.0;
  for (std::size_t k = 0; k < n; ++k) {
    const auto next = corners[k + 1 == n ? 0 : k + 1] - corners[k];
    const auto previous = corners[k == 0 ? n - 1 : k - 1] - corners[k];
    const Real area = determinant(next, previous);
    all_positive = area > 0.0 ? all_positive : Real{};
    sum += corner_mean_ratio(next, previous, area, regular);
  }
  return all_positive > 0.0 ? zero_unless_finite(sum / static_cast<double>(n)) : Real{};
}

/// Mean ratio quality number of a planar polygon with three or more counterclockwise corners
/// (thesis, Section 3.1). For five and more corners it is the mean over the corner triangles,
/// relative to those of the regular n-gon. In (0, 1], 1 exactly for regular polygons, invariant
/// under similarity. 0 for an invalid cell, which has a corner with det(D) <= 0 (or not a number).
template <class Real, std::size_t extent>
inline Real mean_ratio(std::span<const Vector2<Real>, extent> corners) {
  return polygon_mean_ratio(
      corners, [](Vector2<Real> next, Vector2<Real> previous) { return cross(next, previous); });
}

/// Orientation of planar and volume cells, given by space itself. For cells of a surface mesh, the
/// normal of the initial cell shows the upper side.
struct OrientedBySpace {};
template <int dim, int spacedim>
inline auto upper_side(const Mesh<dim, spacedim>& mesh, CellIndex cell) {
  if constexpr (dim == spacedim)
    return OrientedBySpace{};
  else
    return vector_of(mesh.constraints()->facet_normals()[cell]);
}

/// Mean ratio of a polygon in space, from the lengths and areas of its corners' triangles in space:
/// 1 exactly for regular, flat polygons. A corner is invalid if it does not show the upper side of
/// the surface, even if the polygon's mean normal does. `upper` is a vector along the surface's
/// normal there. The mean normal of a thin polygon on a curved surface is unreliable.
template <std::size_t extent>
inline double mean_ratio(Vector3<double> upper, std::span<const Vector3<double>, extent> corners) {
  return polygon_mean_ratio(corners, [&](Vector3<double> next, Vector3<double> previous) {
    const Vector3<double> area = cross(next, previous);
    return std::copysign(length_of_any_size(area), dot(area, upper) > 0.0 ? 1.0 : -1.0);
  });
}

/// det(S) and |S|^2 of one corner of a volume cell, S = D W^-1. D has the edges from the corner to
/// its neighbours as columns, W those of the regular element (thesis, Definition 3.2).
template <class Real>
struct CornerShape {
  Real determinant, squared_norm;
};

/// Returns the shape of corner k of the volume cell with these edges.
template <std::size_t k, class Real, std::size_t n>
inline CornerShape<Real> corner_shape(const CellEdges<Real, n>& edges) {
  using Element = VolumeElement<n>;
  constexpr LocalSimplex corner = Element::corners[k];
  constexpr DirectedEdge a = edge_between<n>(corner[0], corner[1]),
                         b = edge_between<n>(corner[0], corner[2]),
                         c = edge_between<n>(corner[0], corner[3]);
  constexpr auto& g = Element::regular.inverse_gram;
  constexpr double sign = (a.reversed != b.reversed) != c.reversed ? -1.0 : 1.0;
  const auto &u = edges.vectors[a.index], &v = edges.vectors[b.index], &w = edges.vectors[c.index];
  CornerShape<Real> shape;
  shape.determinant = (sign / Element::regular.determinant) * determinant(u, v, w);
  const auto& squares = edges.squared_lengths;
  if constexpr (n == 4) {  // the inverse Gram matrix makes it symmetric in all six edges
    shape.squared_norm =
        0.5 * ((squares[0] + squares[1] + squares[2]) + (squares[3] + squares[4] + squares[5]));
  } else {
    shape.squared_norm =
        g[0][0] * squares[a.index] + g[1][1] * squares[b.index] + g[2][2] * squares[c.index];
    if constexpr (g[0][1] != 0.0)
      shape.squared_norm += (a.reversed != b.reversed ? -2.0 : 2.0) * g[0][1] * dot(u, v);
    if constexpr (g[0][2] != 0.0)
      shape.squared_norm += (a.reversed != c.reversed ? -2.0 : 2.0) * g[0][2] * dot(u, w);
    if constexpr (g[1][2] != 0.0)
      shape.squared_norm += (b.reversed != c.reversed ? -2.0 : 2.0) * g[1][2] * dot(v, w);
  }
  return shape;
}

/// Mean ratio quality number of a volume cell with n = 4, 5, 6 or 8 nodes (thesis, Definition 3.2).
/// It is the mean of 3 det(S)^(2/3) / |S|^2 over its corners; a tetrahedron counts one corner, and
/// a pyramid the four of its base. In (0, 1], 1 exactly (up to rounding) for regular cells,
/// invariant under similarity. 0 for an invalid cell, which has a corner with det(D) <= 0 (or not a
/// number).
template <class Real, std::size_t n>
inline Real mean_ratio(const CellEdges<Real, n>& edges) {
  constexpr std::size_t n_corners = VolumeElement<n>::corners.size();
  Real sum{}, all_positive = Real{} + 1.0;
  unrolled<n_corners>([&](auto k) {
    const CornerShape<Real> shape = corner_shape<k>(edges);
    all_positive = shape.determinant > 0.0 ? all_positive : Real{};
    sum += shape.determinant * inverse_root<3>(shape.determinant) / shape.squared_norm;
  });
  return all_positive > 0.0 ? zero_unless_finite(sum * (3.0 / static_cast<double>(n_corners)))
                            : Real{};
}
template <class Real, std::size_t n>
inline Real mean_ratio(std::span<const Vector3<Real>, n> nodes) {
  return mean_ratio(CellEdges<Real, n>(nodes));
}

/// Mean ratio of a planar or volume cell, for code that handles both.
template <class Corners>
inline auto mean_ratio(OrientedBySpace, Corners corners) {
  return mean_ratio(corners);
}

/// Mean ratio of a cell of a mesh, relative to its target if the mesh has targets.
double cell_mean_ratio(const PlanarMesh& mesh, CellIndex cell);
double cell_mean_ratio(const VolumeMesh& mesh, CellIndex cell);
double cell_mean_ratio(const SurfaceMesh& mesh, CellIndex cell);

}  // namespace smoothfem
