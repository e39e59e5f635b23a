// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/second_order/jacobian_polynomial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "smoothing/second_order/shape_functions.h"
#include "smoothing/simd/vectors.h"

namespace smoothfem {

namespace {

std::vector<BernsteinFactor> jacobian_factors(const SecondOrderType& type) {
  if (type.dim == 2) {
    if (type.n_corners == 3) return {{2, type.n_nodes == 7 ? 4 : 2}};
    return {{1, 3}, {1, 3}};
  }
  switch (type.n_corners) {
    case 4:
      return {{3, 3}};
    case 5:
      return {{1, 5}, {1, 5}, {1, 3}};
    case 6:
      return {{2, 4}, {1, 5}};
    default:
      return {{1, 5}, {1, 5}, {1, 5}};
  }
}

/// Bound of the relative error after n rounded operations; a tenth more for terms of higher order
/// and for the rounding of the bound.
constexpr double rounding(std::size_t n) {
  return 1.1 * static_cast<double>(n) * 0x1p-53;
}

/// Raises a bound to `value` where that is greater.
void raise(Lanes& bound, Lanes value) {
  bound = value > bound ? value : bound;
}
double greatest(Lanes values) {
  double result = values[0];
  for (std::size_t l = 1; l < n_lanes; ++l) result = std::max(result, values[l]);
  return result;
}

}  // namespace

/// Numbers that depend on the type of a cell only.
struct JacobianTable {
  explicit JacobianTable(const SecondOrderType& type);

  BernsteinSpace space;
  /// Collapsed derivatives of the functions k = 1, 2, ... at the points of the space. Those of
  /// n_lanes points, direction d and function k begin at ((block * (n-1) + k-1) * dim + d) *
  /// n_lanes.
  std::vector<double> derivatives;
  /// Greatest sum of the absolute derivatives at a point, for each direction.
  std::array<double, 3> derivative_sums{};
  /// Integrals of the basis functions over the cell.
  std::vector<double> integrals;
};

JacobianTable::JacobianTable(const SecondOrderType& type) : space(jacobian_factors(type)) {
  const auto dim = static_cast<std::size_t>(type.dim);
  const ShapeFunctions& functions = shape_functions(type.dim, type.n_nodes);
  const std::size_t n = type.n_nodes, n_points = space.size();
  const std::size_t n_blocks = (n_points + n_lanes - 1) / n_lanes;
  derivatives.resize(n_blocks * (n - 1) * dim * n_lanes);
  for (std::size_t p = 0; p < n_blocks * n_lanes; ++p) {  // the last point fills the last block
    const auto at_point =
        functions.collapsed_derivatives(space.points()[std::min(p, n_points - 1)]);
    for (std::size_t d = 0; d < dim; ++d) {
      double sum = 0.0;
      for (std::size_t k = 1; k < n; ++k) {
        const double derivative = at_point[k][static_cast<Eigen::Index>(d)];
        derivatives[((p / n_lanes * (n - 1) + k - 1) * dim + d) * n_lanes + p % n_lanes] =
            derivative;
        sum += std::abs(derivative);
      }
      derivative_sums[d] = std::max(derivative_sums[d], sum);
    }
  }

  // All basis functions of a simplex have the same integral.
  double measure = 1.0;
  for (const auto& [factor_dim, degree] : jacobian_factors(type))
    measure /= factor_dim == 3 ? 6.0 : factor_dim == 2 ? 2.0 : 1.0;
  integrals.assign(n_points, measure / static_cast<double>(n_points));
  if (type.n_corners == 5) {  // collapsing reduces areas by (1-z)^2; z runs slowest
    constexpr std::array<double, 4> along_z{1.0 / 6.0, 1.0 / 10.0, 1.0 / 20.0, 1.0 / 60.0};
    const std::size_t n_per_layer = n_points / along_z.size();
    for (std::size_t i = 0; i < n_points; ++i)
      integrals[i] = along_z[i / n_per_layer] / static_cast<double>(n_per_layer);
  }
}

template <int dim>
JacobianPolynomial<dim>::JacobianPolynomial(std::span<const Point<dim>> points)
    : table_(&table_of_type<JacobianTable>(dim, points.size())), error_(0.0), exponent_(0) {
  const std::size_t n = points.size(), n_coefficients = space().size();
  std::array<Point<dim>, max_second_order_nodes> moved;
  double largest = 0.0, sum = 0.0;
  for (std::size_t k = 1; k < n; ++k) {
    moved[k] = points[k] - points[0];
    for (int d = 0; d < dim; ++d) {
      largest = std::max(largest, std::abs(moved[k][d]));
      sum += 0.0 * moved[k][d];
    }
  }
  if (sum != 0.0) {  // not a number, from infinity or not a number
    coefficients_.fill(0.0);
    error_ = std::numeric_limits<double>::infinity();
    return;
  }
  const int halvings = std::clamp(std::ilogb(largest) + 1, -1000, 1024);
  const double scale = std::ldexp(1.0, -halvings);
  exponent_ = dim * halvings;
  std::array<Vector<dim, Lanes>, max_second_order_nodes> scaled;
  for (std::size_t k = 1; k < n; ++k) {
    const Point<dim> point = scale * moved[k];
    if constexpr (dim == 2)
      scaled[k] = {Lanes{} + point[0], Lanes{} + point[1]};
    else
      scaled[k] = {Lanes{} + point[0], Lanes{} + point[1], Lanes{} + point[2]};
  }

  std::array<Lanes, dim> squared_columns{};
  Lanes largest_values{};
  const double* derivatives = table_->derivatives.data();
  for (std::size_t p = 0; p < n_coefficients; p += n_lanes) {
    std::array<Vector<dim, Lanes>, dim> columns{};
    for (std::size_t k = 1; k < n; ++k)
      for (std::size_t d = 0; d < dim; ++d) {
        columns[d] = columns[d] + load_lanes(derivatives) * scaled[k];
        derivatives += n_lanes;
      }
    for (std::size_t d = 0; d < dim; ++d) raise(squared_columns[d], squared_length(columns[d]));
    Lanes values;
    if constexpr (dim == 2)
      values = cross(columns[0], columns[1]);
    else
      values = determinant(columns[0], columns[1], columns[2]);
    raise(largest_values, values < 0.0 ? -values : values);
    store_lanes(values, coefficients_.data() + p);
  }
  space().to_coefficients({coefficients_.data(), n_coefficients});

  // A determinant is at most the product of its columns' lengths. That bounds what errors of the
  // columns change. Each of its n_terms terms has five rounded operations.
  constexpr double n_terms = dim == 2 ? 2.0 : 6.0;
  double product = 1.0, change = 0.0;
  for (std::size_t d = 0; d < dim; ++d) {
    const double length = (1.0 + rounding(4)) * std::sqrt(greatest(squared_columns[d]));
    const double error =
        std::sqrt(dim) * rounding(n + 3) * table_->derivative_sums[d] * (scale * largest);
    change = change * (length + error) + product * error;
    product *= length;
  }
  error_ = space().conversion_norm() * (change + n_terms * rounding(5) * product) +
           space().conversion_error() * greatest(largest_values) +
           std::numeric_limits<double>::min();
}

template <int dim>
const BernsteinSpace& JacobianPolynomial<dim>::space() const {
  return table_->space;
}

template <int dim>
double JacobianPolynomial<dim>::cell_size() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < space().size(); ++i) sum += table_->integrals[i] * coefficients_[i];
  return std::ldexp(sum, exponent_);
}

template class JacobianPolynomial<2>;
template class JacobianPolynomial<3>;

}  // namespace smoothfem
