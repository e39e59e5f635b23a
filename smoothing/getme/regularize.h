// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <numbers>

#include "smoothing/getme/element_parameters.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/transformations/dual_element.h"
#include "smoothing/transformations/opposite_face_normals.h"
#include "smoothing/transformations/polygon_transformation.h"
#include "smoothing/transformations/scaling.h"

namespace smoothfem {

/// The element step of GETMe: transform, keep centroid and size, relax. A target size is passed to
/// each step if the scaling fits the neighbours (NeighbourSizes).
template <int dim, int spacedim = dim>
class ElementRegularization;

template <>
class ElementRegularization<2> {
 public:
  explicit ElementRegularization(const ElementParameters<2>& parameters)
      : transformation_(parameters.lambda, parameters.theta_degrees * std::numbers::pi / 180.0),
        rho_(parameters.rho),
        fits_neighbours_(parameters.scaling == ElementParameters<2>::neighbour_mean_size) {}

  /// True if steps take a target size.
  bool fits_neighbours() const { return fits_neighbours_; }

  /// Transforms a polygon. Returns its mean ratio, which planar transformations do not depend on.
  template <class Real, std::size_t extent>
  inline Real regularize(std::span<const Vector2<Real>, extent> polygon,
                         std::span<Vector2<Real>, extent> result, Real size = Real{}) const {
    return regularize(polygon, result, size, fits_neighbours_);
  }
  /// Does the same in loops that know at compile time whether steps take a target size. A polygon's
  /// step is so short that a run-time check would show. Fits: std::true_type or std::false_type.
  template <class Real, std::size_t extent, class Fits>
  inline Real regularize(std::span<const Vector2<Real>, extent> polygon,
                         std::span<Vector2<Real>, extent> result, Real size, Fits fits) const {
    transformation_.apply(polygon, result);
    if (fits)
      give_size<2>(polygon, size, result);
    else
      keep_mean_edge_length(polygon, result);
    if (rho_ != 1.0) relax(polygon, result, rho_);
    return mean_ratio(polygon);
  }

 protected:
  PolygonTransformation transformation_;
  double rho_;
  bool fits_neighbours_;
};

/// Polygons of a surface in space: the planar step in the plane across the mean normal of each.
template <>
class ElementRegularization<2, 3> : public ElementRegularization<2> {
 public:
  using ElementRegularization<2>::ElementRegularization;

  /// Transforms a polygon. Returns its mean ratio; upper: see mean_ratio.
  template <std::size_t extent>
  double regularize(Vector3<double> upper, std::span<const Vector3<double>, extent> polygon,
                    std::span<Vector3<double>, extent> result, double size = 0.0) const {
    transformation_.apply(unit_normal(polygon), polygon, result);
    if (fits_neighbours_)
      give_size<2>(polygon, size, result);
    else
      keep_mean_edge_length(polygon, result);
    if (rho_ != 1.0) relax(polygon, result, rho_);
    return mean_ratio(upper, polygon);
  }
};

template <>
class ElementRegularization<3> {
 public:
  explicit ElementRegularization(const ElementParameters<3>& parameters)
      : parameters_(parameters) {}

  bool fits_neighbours() const {
    return parameters_.scaling == ElementParameters<3>::neighbour_mean_size;
  }

  /// Transforms a cell. Returns its mean ratio, which the normals' factor depends on.
  template <class Real, std::size_t n>
  inline Real regularize(std::span<const Vector3<Real>, n> nodes,
                         std::span<Vector3<Real>, n> result, Real size = Real{}) const {
    using Parameters = ElementParameters<3>;
    const CellEdges<Real, n> edges(nodes);
    const Real quality = mean_ratio(edges);
    const SigmaRange& range = parameters_.sigma(n);
    const Real sigma = range.low + (range.high - range.low) * (1.0 - quality);
    if constexpr (n == 4) {
      if (parameters_.tetrahedron_transformation == Parameters::opposite_face_normals)
        OppositeFaceNormals::apply(sigma, nodes, result);
      else
        DualElement::apply(sigma, nodes, result);
    } else {
      DualElement::apply(sigma, nodes, result);
    }
    if (parameters_.scaling == Parameters::mean_edge_length)
      keep_mean_edge_length(nodes, edges, result);
    else if (parameters_.scaling == Parameters::mean_volume)
      keep_mean_volume(nodes, result);
    else
      give_size<3>(nodes, size, result);
    if (parameters_.rho != 1.0) relax(nodes, result, parameters_.rho);
    return quality;
  }

 private:
  ElementParameters<3> parameters_;
};

/// Calls the step of a cell of any kind of mesh.
template <int dim, int spacedim, class Upper, class Corners, class Result>
inline double regularize(const ElementRegularization<dim, spacedim>& element, Upper upper,
                         Corners corners, Result result, double size) {
  if constexpr (dim == spacedim)
    return element.regularize(corners, result, size);
  else
    return element.regularize(upper, corners, result, size);
}

}  // namespace smoothfem
