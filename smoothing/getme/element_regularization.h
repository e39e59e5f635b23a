#pragma once

#include <array>
#include <numbers>

#include "smoothing/loop/parameter.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/transformations/dual_element.h"
#include "smoothing/transformations/opposite_face_normals.h"
#include "smoothing/transformations/polygon_transformation.h"
#include "smoothing/transformations/scaling.h"

namespace smoothfem {

/// The element step of GETMe: transform, keep centroid and size, relax. Parameters of a method, and
/// the step itself for cells of any type.
template <int dim, int spacedim = dim>
class ElementRegularization;

template <>
class ElementRegularization<2> {
 public:
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

  /// Call before regularize, after parameters have changed.
  void prepare() { transformation_ = {lambda, theta_degrees * std::numbers::pi / 180.0}; }

  /// Returns the mean ratio of the polygon, which planar transformations do not depend on.
  template <class Real, std::size_t extent>
  SMOOTHFEM_INLINE Real regularize(std::span<const Vector2<Real>, extent> polygon,
                                   std::span<Vector2<Real>, extent> result) const {
    transformation_.apply(polygon, result);
    keep_mean_edge_length(polygon, result);
    if (rho != 1.0) relax(polygon, result, rho);
    return mean_ratio(polygon);
  }

 protected:
  PolygonTransformation transformation_{0.5, 0.5};
};

/// Polygons of a surface in space: the planar step in the plane across each one's mean normal.
template <>
class ElementRegularization<2, 3> : public ElementRegularization<2> {
 public:
  ElementRegularization(const ElementRegularization<2>& planar)
      : ElementRegularization<2>(planar) {}

  /// upper: see mean_ratio, which is returned.
  template <std::size_t extent>
  double regularize(Vector3<double> upper, std::span<const Vector3<double>, extent> polygon,
                    std::span<Vector3<double>, extent> result) const {
    transformation_.apply(unit_normal(polygon), polygon, result);
    keep_mean_edge_length(polygon, result);
    if (rho != 1.0) relax(polygon, result, rho);
    return mean_ratio(upper, polygon);
  }
};

/// The scaling factor sigma of the normals, from `low` for regular elements to `high` for those of
/// quality zero (thesis, Section 4.2).
struct SigmaRange {
  double low, high;
};

template <>
class ElementRegularization<3> {
 public:
  enum TetrahedronTransformation { opposite_face_normals, dual_element };

  SigmaRange tetrahedron, pyramid, prism, hexahedron;
  double rho;
  int tetrahedron_transformation = opposite_face_normals;
  int scaling = static_cast<int>(ScalingRule::mean_edge_length);

  Parameters parameters() {
    Parameters all;
    const auto add_sigma = [&all](const std::string& type, SigmaRange& sigma) {
      constexpr double largest = 1e4;
      all.push_back({"sigma_" + type + "_min",
                     "scaling factor of the normals for a " + type + " of quality 1 (Section 4.2)",
                     &sigma.low, 0.0, largest});
      all.push_back({"sigma_" + type + "_max", "the same for quality 0, linear between them",
                     &sigma.high, 0.0, largest});
    };
    add_sigma("tetrahedron", tetrahedron);
    add_sigma("pyramid", pyramid);
    add_sigma("prism", prism);
    add_sigma("hexahedron", hexahedron);
    all.push_back({"rho",
                   "relaxation, in (0, 1]; 1 takes the transformed element as it is (Eq. "
                   "3.12)",
                   &rho, 1e-9, 1.0});
    all.push_back({"tetrahedron_transformation",
                   "how tetrahedra are transformed (Sections 3.2, 3.3)",
                   Choice{&tetrahedron_transformation, {"opposite-face-normals", "dual-element"}}});
    all.push_back({"scaling", "what an element keeps (Section 3.3)",
                   Choice{&scaling, {"mean-edge-length", "mean-volume"}}});
    return all;
  }

  void prepare() {}

  /// Returns the mean ratio of the cell, which the normals' factor depends on.
  template <class Real, std::size_t n>
  SMOOTHFEM_INLINE Real regularize(std::span<const Vector3<Real>, n> nodes,
                                   std::span<Vector3<Real>, n> result) const {
    const CellEdges<Real, n> edges(nodes);
    const Real quality = mean_ratio(edges);
    const SigmaRange& range = n == 4 ? tetrahedron : n == 5 ? pyramid : n == 6 ? prism : hexahedron;
    const Real sigma = range.low + (range.high - range.low) * (1.0 - quality);
    if constexpr (n == 4) {
      if (tetrahedron_transformation == opposite_face_normals)
        OppositeFaceNormals::apply(sigma, nodes, result);
      else
        DualElement::apply(sigma, nodes, result);
    } else {
      DualElement::apply(sigma, nodes, result);
    }
    keep_centroid_and_size(static_cast<ScalingRule>(scaling), nodes, edges, result);
    if (rho != 1.0) relax(nodes, result, rho);
    return quality;
  }
};

/// One line for cells of every kind of mesh.
template <int dim, int spacedim, class Upper, class Corners, class Result>
SMOOTHFEM_INLINE double regularize(const ElementRegularization<dim, spacedim>& element, Upper upper,
                                   Corners corners, Result result) {
  if constexpr (dim == spacedim)
    return element.regularize(corners, result);
  else
    return element.regularize(upper, corners, result);
}

}  // namespace smoothfem
