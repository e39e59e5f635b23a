#pragma once

#include <string>
#include <vector>

#include "smoothing/mesh/element_type.h"

namespace smoothfem {

/// Values at the points of one quadrature rule on a reference cell. All arrays run over the points
/// first, then over the dofs (or vertices); gradients have two entries each.
struct QuadratureTable {
  std::size_t n_points = 0;
  std::vector<double> weights;
  std::vector<double> shape, shape_gradient;        ///< of the finite element
  std::vector<double> geometry, geometry_gradient;  ///< of the straight-sided mapping (degree 1)
};

/// A Lagrange element on its reference cell. Vertices and dofs are in deal.II's order.
struct ReferenceElement {
  ElementType type;
  std::size_t n_vertices = 0;
  std::size_t n_dofs = 0;
  /// Geometry shape functions at the dofs' support points, n_dofs x n_vertices: where a dof is.
  std::vector<double> support;
  QuadratureTable matrices;  ///< for stiffness, mass and load
  QuadratureTable errors;    ///< for norms and errors
};

/// Degree 1 or 2 on triangles (3/6 nodes) or quadrilaterals (4/9 nodes). Triangles: matrices exact,
/// errors by a rule of degree 11. Quadrilaterals: tensor Gauss rule with n_quadrilateral_points a
/// direction for both; the stiffness of a distorted quadrilateral is rational, so no rule is exact.
ReferenceElement make_reference_element(ElementType type, int degree, int n_quadrilateral_points);

}  // namespace smoothfem
