// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/fe/fe.h>

#include <Eigen/LU>
#include <array>
#include <optional>
#include <vector>

#include "fem/elements/curved_cells.h"

// Includes deal.II's headers: for sources of this library only.

namespace smoothfem {

/// The value of a function at a point of the reference cell, and its gradient.
template <int dim>
struct Derivable {
  double value = 0.0;
  std::array<double, dim> gradient{};

  friend Derivable operator*(const Derivable& a, const Derivable& b) {
    Derivable product{.value = a.value * b.value};
    for (std::size_t d = 0; d < dim; ++d)
      product.gradient[d] = a.gradient[d] * b.value + a.value * b.gradient[d];
    return product;
  }
};

/// The functions of a cell's mapping: one for each of its points (MappingPoints), which is 1 there
/// and 0 at the others. On straight-sided cells these are deal.II's functions of degree 1. On
/// curved cells they span
///
///   triangle                  polynomials of degree 2, and the bubble x y (1 - x - y)
///   tetrahedron               polynomials of degree 2
///   quadrilateral, hexahedron polynomials of degree 2 in each direction
///   prism                     those of degree 2 in the triangle times those of degree 2 across
///   pyramid                   polynomials of degree 2, and r, r x, r y, r r with r = x y / (1 - z)
///                             (Bergot, Cohen, Durufle 2010)
template <int dim>
class MappingFunctions {
 public:
  /// linear: the element of degree 1; must outlive this.
  MappingFunctions(const dealii::FiniteElement<dim>& linear, bool curved)
      : linear_(linear), points_(mapping_points(dim, linear.n_dofs_per_cell(), curved)) {
    if (!curved) return;
    const auto& vertices = linear.get_unit_support_points();
    Eigen::MatrixXd at_points(static_cast<Eigen::Index>(points_.size()),
                              static_cast<Eigen::Index>(points_.size()));
    for (std::size_t p = 0; p < points_.size(); ++p) {
      dealii::Point<dim> point;
      for (const std::size_t v : points_.places[p])
        point += (1.0 / static_cast<double>(points_.places[p].size())) * vertices[v];
      const auto basis = basis_at(point);
      for (std::size_t k = 0; k < basis.size(); ++k)
        at_points(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(k)) = basis[k].value;
    }
    coefficients_ = at_points.inverse();
  }

  const MappingPoints& points() const { return points_; }

  /// Appends the values and gradients of all functions at a point.
  void append(const dealii::Point<dim>& point, std::vector<double>& values,
              std::vector<double>& gradients) const {
    if (coefficients_.size() == 0) {
      for (unsigned int i = 0; i < linear_.n_dofs_per_cell(); ++i) {
        values.push_back(linear_.shape_value(i, point));
        const auto gradient = linear_.shape_grad(i, point);
        for (int d = 0; d < dim; ++d) gradients.push_back(gradient[d]);
      }
      return;
    }
    const auto basis = basis_at(point);
    for (Eigen::Index p = 0; p < coefficients_.cols(); ++p) {
      Derivable<dim> sum;
      for (std::size_t k = 0; k < basis.size(); ++k) {
        const double c = coefficients_(static_cast<Eigen::Index>(k), p);
        sum.value += c * basis[k].value;
        for (std::size_t d = 0; d < dim; ++d) sum.gradient[d] += c * basis[k].gradient[d];
      }
      values.push_back(sum.value);
      gradients.insert(gradients.end(), sum.gradient.begin(), sum.gradient.end());
    }
  }

 private:
  using Functions = std::vector<Derivable<dim>>;

  static Functions products(const Functions& a, const Functions& b) {
    Functions all;
    for (const auto& f : a)
      for (const auto& g : b) all.push_back(f * g);
    return all;
  }

  Functions basis_at(const dealii::Point<dim>& point) const {
    const Derivable<dim> one{.value = 1.0};
    std::array<Derivable<dim>, dim> x;
    for (std::size_t d = 0; d < dim; ++d) {
      x[d].value = point[static_cast<unsigned int>(d)];
      x[d].gradient[d] = 1.0;
    }
    const auto squares = [&](std::size_t d) { return Functions{one, x[d], x[d] * x[d]}; };
    // Polynomials of degree 2 in the first n directions.
    [[maybe_unused]] const auto quadratic = [&](std::size_t n) {
      Functions all{one};
      for (std::size_t a = 0; a < n; ++a) {
        all.push_back(x[a]);
        for (std::size_t b = a; b < n; ++b) all.push_back(x[a] * x[b]);
      }
      return all;
    };
    [[maybe_unused]] const std::size_t n_vertices = linear_.n_dofs_per_cell();
    if constexpr (dim == 1) return squares(0);
    if constexpr (dim == 2) {
      if (n_vertices == 4) return products(squares(0), squares(1));
      const Derivable<dim> rest{.value = 1.0 - x[0].value - x[1].value, .gradient = {-1.0, -1.0}};
      Functions all = quadratic(2);
      all.push_back(x[0] * x[1] * rest);
      return all;
    }
    if constexpr (dim == 3) {
      if (n_vertices == 8) return products(products(squares(0), squares(1)), squares(2));
      if (n_vertices == 6) return products(quadratic(2), squares(2));
      Functions all = quadratic(3);
      if (n_vertices == 4) return all;
      // At the apex x y / (1 - z) tends to 0. No rule has a point there.
      const double height = 1.0 - x[2].value, inverse = height > 0.0 ? 1.0 / height : 0.0;
      const Derivable<dim> reciprocal{.value = inverse, .gradient = {0.0, 0.0, inverse * inverse}};
      const auto r = x[0] * x[1] * reciprocal;
      for (const auto& f : {r, r * x[0], r * x[1], r * r}) all.push_back(f);
      return all;
    }
  }

  const dealii::FiniteElement<dim>& linear_;
  MappingPoints points_;
  Eigen::MatrixXd coefficients_;  ///< of the basis in each function; empty on straight cells
};

}  // namespace smoothfem
