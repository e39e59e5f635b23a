// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/second_order/shape_functions.h"

#include <Eigen/LU>
#include <algorithm>
#include <string>

#include "smoothing/base/input_error.h"
#include "smoothing/mesh/midside_nodes.h"
#include "smoothing/mesh/volume_elements.h"

namespace smoothfem {

namespace {

std::vector<Point<3>> reference_corners(const SecondOrderType& type) {
  const auto n = type.n_corners;
  if (type.dim == 3 && n == 4) return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<Point<3>> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  if (n == 3 || n == 6) corners.erase(corners.begin() + 2);  // the base is a triangle
  if (n == 5) corners.emplace_back(0, 0, 1);
  if (n == 6 || n == 8)
    for (std::size_t k = 0; k < n / 2; ++k) corners.push_back(corners[k] + Point<3>(0, 0, 1));
  return corners;
}

/// True if the space of a type has the function x^a y^b z^c or, in a pyramid,
/// xi^a eta^b (1-z)^max(a,b) z^c.
bool has_function(const SecondOrderType& type, int a, int b, int c) {
  const auto n = type.n_nodes;
  const auto n_squares = (a == 2) + (b == 2) + (c == 2);
  if (type.dim == 2) return c == 0 && (type.n_corners == 3 ? a + b <= 2 : n == 9 || n_squares <= 1);
  switch (type.n_corners) {
    case 4:
      return a + b + c <= 2;
    case 5:
      return c <= 2 - std::max(a, b) && (n == 14 || a * b < 4);
    case 6:
      return a + b <= 2 && (n == 18 || a + b < 2 || c < 2);
    default:
      return n == 27 || n_squares <= 1;
  }
}

bool is_pyramid(const SecondOrderType& type) {
  return type.n_corners == 5;
}

/// Number to the power of `exponent`; 0 for negative exponents, which only factors of 0 have.
template <class Real>
Real power(Real base, int exponent) {
  if (exponent < 0) return 0;
  Real result = 1;
  for (int i = 0; i < exponent; ++i) result *= base;
  return result;
}

}  // namespace

ShapeFunctions::ShapeFunctions(const SecondOrderType& type)
    : type_(type), nodes_(reference_corners(type)) {
  const auto [dim, n_corners, n] = type;
  const auto counts = midside_counts(dim, n_corners, n - n_corners);
  const auto add_middle = [&](const auto& positions) {
    Point<3> sum = Point<3>::Zero();
    for (const auto k : positions) sum += nodes_[k];
    nodes_.push_back(sum / static_cast<double>(std::size(positions)));
  };
  for_each_edge(dim, n_corners, [&](std::size_t a, std::size_t b) {
    add_middle(std::array{a, b});
  });
  if (counts.faces > 0)
    for_each_quadrilateral_face(n_corners,
                                [&](const LocalFace& face) { add_middle(face.indices()); });
  if (counts.cell > 0) {
    std::vector<std::size_t> all(n_corners);
    for (std::size_t k = 0; k < n_corners; ++k) all[k] = k;
    add_middle(all);
  }

  for (int c = 0; c <= 2; ++c)
    for (int b = 0; b <= 2; ++b)
      for (int a = 0; a <= 2; ++a)
        if (has_function(type, a, b, c))
          monomials_.push_back({{a, b, c}, is_pyramid(type) ? std::max(a, b) : 0});
  if (dim == 2 && n == 7) monomials_.push_back({{1, 1, 0}, 1});

  Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> at_nodes(n, n);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t m = 0; m < n; ++m)
      at_nodes(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(m)) =
          value(monomials_[m], collapsed(nodes_[k]));
  const Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> inverse =
      at_nodes.inverse();
  coefficients_.assign(inverse.data(), inverse.data() + n * n);
}

ShapeFunctions::Real ShapeFunctions::value(const Monomial& monomial, const Point<3>& u) const {
  const Real x = u[0], y = u[1], z = u[2], l = is_pyramid(type_) ? 1 - z : 1 - x - y;
  return power(x, monomial.powers[0]) * power(y, monomial.powers[1]) *
         power(z, monomial.powers[2]) * power(l, monomial.power_of_l);
}

ShapeFunctions::Real ShapeFunctions::derivative(const Monomial& monomial, int d,
                                                const Point<3>& u) const {
  const bool pyramid = is_pyramid(type_);
  const bool changes_l = pyramid == (d == 2);
  const auto factor = monomial.powers[static_cast<std::size_t>(d)];
  Monomial lower = monomial, lower_l = monomial;
  --lower.powers[static_cast<std::size_t>(d)];
  --lower_l.power_of_l;
  if (pyramid && !changes_l) --lower.power_of_l;  // the division by 1-z
  return static_cast<Real>(factor) * value(lower, u) -
         (changes_l ? static_cast<Real>(monomial.power_of_l) * value(lower_l, u) : 0);
}

std::vector<double> ShapeFunctions::values(const Point<3>& x) const {
  const std::size_t n = type_.n_nodes;
  const Point<3> u = collapsed(x);
  std::vector<Real> sums(n, 0);
  for (std::size_t m = 0; m < n; ++m) {
    const Real of_monomial = value(monomials_[m], u);
    for (std::size_t k = 0; k < n; ++k) sums[k] += coefficients_[m * n + k] * of_monomial;
  }
  return {sums.begin(), sums.end()};
}

std::vector<Point<3>> ShapeFunctions::collapsed_derivatives(const Point<3>& u) const {
  const std::size_t n = type_.n_nodes;
  std::vector<Point<3>> result(n, Point<3>::Zero());
  std::vector<Real> sums(n);
  for (int d = 0; d < type_.dim; ++d) {
    std::fill(sums.begin(), sums.end(), 0);
    for (std::size_t m = 0; m < n; ++m) {
      const Real of_monomial = derivative(monomials_[m], d, u);
      for (std::size_t k = 0; k < n; ++k) sums[k] += coefficients_[m * n + k] * of_monomial;
    }
    for (std::size_t k = 0; k < n; ++k) result[k][d] = static_cast<double>(sums[k]);
  }
  return result;
}

std::vector<Point<3>> ShapeFunctions::gradients(const Point<3>& x) const {
  const Point<3> u = collapsed(x);
  auto result = collapsed_derivatives(u);
  if (is_pyramid(type_))  // xi and eta depend on z
    for (Point<3>& gradient : result) gradient[2] += u[0] * gradient[0] + u[1] * gradient[1];
  return result;
}

Point<3> ShapeFunctions::collapsed(const Point<3>& x) const {
  if (!is_pyramid(type_)) return x;
  const double l = 1.0 - x[2];
  return l > 0.0 ? Point<3>(x[0] / l, x[1] / l, x[2]) : Point<3>(0.5, 0.5, 1.0);
}

std::size_t second_order_type(int dim, std::size_t n_nodes) {
  for (std::size_t t = 0; t < second_order_types.size(); ++t)
    if (second_order_types[t].dim == dim && second_order_types[t].n_nodes == n_nodes) return t;
  throw InputError("no element of second order of dimension " + std::to_string(dim) + " has " +
                   std::to_string(n_nodes) + " nodes");
}

const ShapeFunctions& shape_functions(int dim, std::size_t n_nodes) {
  return table_of_type<ShapeFunctions>(dim, n_nodes);
}

}  // namespace smoothfem
