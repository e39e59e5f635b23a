// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/quadrature_lib.h>

#include "smoothing/mesh/element_type.h"

// Includes deal.II's headers: for sources of this library only.

namespace smoothfem {

inline bool is_simplex(ElementType type) {
  return type == ElementType::triangle || type == ElementType::tetrahedron;
}

/// Rule on simplices, of degree 5: exact for products of two shape functions of degree 2.
template <int dim>
dealii::Quadrature<dim> simplex_matrix_rule() {
  return dealii::QGaussSimplex<dim>(3);
}

/// Rule on simplices for errors of elements of degree 1 or 2: degree 11 on triangles, 5 or 7 on
/// tetrahedra.
template <int dim>
dealii::Quadrature<dim> simplex_error_rule(int degree) {
  return dealii::QWitherdenVincentSimplex<dim>(dim == 2 ? 6
                                                        : static_cast<unsigned int>(degree) + 2);
}

/// Rule on cells that are not simplices: Gauss points in each direction. On pyramid and prism they
/// come from a cube that is collapsed to the cell. The direction of the collapse has one more
/// point, so that the rule is exact for the same polynomials as on a cube. (The gradients of the
/// pyramid's rational shape functions are polynomials in the cube's coordinates.)
template <int dim>
dealii::Quadrature<dim> gauss_rule(ElementType type, unsigned int n_points) {
  if constexpr (dim == 3) {
    if (type == ElementType::pyramid || type == ElementType::prism) {
      const dealii::QGauss<1> plain(n_points), squeezed(n_points + 1);
      const bool pyramid = type == ElementType::pyramid;
      std::vector<dealii::Point<3>> points;
      std::vector<double> weights;
      for (unsigned int c = 0; c < squeezed.size(); ++c)
        for (unsigned int b = 0; b < plain.size(); ++b)
          for (unsigned int a = 0; a < plain.size(); ++a) {
            const double x = plain.point(a)[0], y = plain.point(b)[0], z = squeezed.point(c)[0];
            const double width = 1.0 - z;
            const double weight = squeezed.weight(c) * plain.weight(b) * plain.weight(a) * width;
            // The pyramid's base is [-1, 1]^2; the prism's triangle lies in the first two
            // directions.
            if (pyramid)
              points.emplace_back(width * (2.0 * x - 1.0), width * (2.0 * y - 1.0), z);
            else
              points.emplace_back(width * x, z, y);
            weights.push_back(pyramid ? 4.0 * width * weight : weight);
          }
      return {points, weights};
    }
  }
  return dealii::QGauss<dim>(n_points);
}

}  // namespace smoothfem
