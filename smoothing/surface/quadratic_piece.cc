// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/surface/quadratic_piece.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "smoothing/second_order/shape_functions.h"

namespace smoothfem {

namespace {

/// Exponents of the functions of an element, as i + 3 j of u^i v^j.
std::vector<std::vector<std::pair<std::size_t, double>>> functions_of(std::size_t n_nodes) {
  switch (n_nodes) {
    case 3:
      return {{{0, 1.0}}, {{1, 1.0}}, {{2, 1.0}}};
    case 6:
    case 7: {
      std::vector<std::vector<std::pair<std::size_t, double>>> functions{
          {{0, 1.0}}, {{1, 1.0}}, {{2, 1.0}}, {{3, 1.0}}, {{4, 1.0}}, {{6, 1.0}}};
      if (n_nodes == 7) functions.push_back({{4, 1.0}, {5, -1.0}, {7, -1.0}});  // u v (1 - u - v)
      return functions;
    }
    default: {
      std::vector<std::vector<std::pair<std::size_t, double>>> functions;
      for (std::size_t k = 0; k < n_nodes; ++k) functions.push_back({{k, 1.0}});
      return functions;  // QUAD8: without u^2 v^2
    }
  }
}

/// Reference coordinates of the nodes.
std::vector<Point<3>> reference_nodes(std::size_t n_nodes) {
  if (n_nodes == 3) return {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.5, 0.0, 0.0}};
  return shape_functions(2, n_nodes).nodes();
}

double power(double u, std::size_t i) {
  return i == 0 ? 1.0 : i == 1 ? u : u * u;
}

/// Returns the matrix that makes coefficients of functions from values at the nodes.
Eigen::MatrixXd interpolation(std::size_t n_nodes) {
  const auto functions = functions_of(n_nodes);
  const auto nodes = reference_nodes(n_nodes);
  const auto n = static_cast<Eigen::Index>(n_nodes);
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t k = 0; k < n_nodes; ++k)
    for (std::size_t f = 0; f < n_nodes; ++f)
      for (const auto& [exponents, factor] : functions[f])
        values(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(f)) +=
            factor * power(nodes[k].x(), exponents % 3) * power(nodes[k].y(), exponents / 3);
  return values.inverse();
}

const Eigen::MatrixXd& interpolation_of(std::size_t n_nodes) {
  static const Eigen::MatrixXd segment = interpolation(3), triangle = interpolation(6),
                               bubble = interpolation(7), serendipity = interpolation(8),
                               complete = interpolation(9);
  return n_nodes == 3   ? segment
         : n_nodes == 6 ? triangle
         : n_nodes == 7 ? bubble
         : n_nodes == 8 ? serendipity
                        : complete;
}

}  // namespace

QuadraticPiece::QuadraticPiece(std::span<const Point<3>> nodes)
    : kind_(nodes.size() == 3   ? Kind::segment
            : nodes.size() <= 7 ? Kind::triangle
                                : Kind::quadrilateral) {
  coefficients_.fill(Point<3>::Zero());
  const auto functions = functions_of(nodes.size());
  const auto& matrix = interpolation_of(nodes.size());
  for (std::size_t f = 0; f < functions.size(); ++f) {
    Point<3> sum = Point<3>::Zero();
    for (std::size_t k = 0; k < nodes.size(); ++k)
      sum += matrix(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(k)) * nodes[k];
    for (const auto& [exponents, factor] : functions[f]) coefficients_[exponents] += factor * sum;
  }
  const auto reference = reference_nodes(nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    starts_[n_starts_] = nodes[k];
    start_at_[n_starts_++] = {reference[k].x(), reference[k].y()};
  }
  set_box(nodes);
}

/// The piece is within the box of its corners, enlarged by the offsets of the other nodes from the
/// straight element, because hierarchical shape functions are at most 1.
void QuadraticPiece::set_box(std::span<const Point<3>> nodes) {
  const std::size_t n_corners = kind_ == Kind::segment ? 2 : kind_ == Kind::triangle ? 3 : 4;
  Point<3> low = nodes[0], high = nodes[0], offset = Point<3>::Zero();
  for (std::size_t k = 1; k < n_corners; ++k) {
    low = low.cwiseMin(nodes[k]);
    high = high.cwiseMax(nodes[k]);
  }
  Point<3> middle = Point<3>::Zero();  // of an element without a node there
  for (std::size_t k = n_corners; k < nodes.size(); ++k) {
    Point<3> straight = Point<3>::Zero();
    const std::size_t side = k - n_corners;
    if (kind_ == Kind::segment || side < n_corners) {
      straight = 0.5 * (nodes[side] + nodes[(side + 1) % n_corners]);
      middle += (nodes[k] - straight).cwiseAbs();
    } else {
      for (std::size_t c = 0; c < n_corners; ++c)
        straight += nodes[c] / static_cast<double>(n_corners);
      offset += middle;
    }
    offset += (nodes[k] - straight).cwiseAbs();
  }
  box_ = {low - 2.0 * offset, high + 2.0 * offset};
}

QuadraticPiece::Jet QuadraticPiece::at(double u, double v) const {
  // By powers of v: position, first and second derivatives in u.
  std::array<Point<3>, n_powers> x, x_u, x_uu;
  for (std::size_t j = 0; j < n_powers; ++j) {
    const Point<3>* c = &coefficients_[n_powers * j];
    x[j] = c[0] + u * (c[1] + u * c[2]);
    x_u[j] = c[1] + 2.0 * u * c[2];
    x_uu[j] = 2.0 * c[2];
  }
  return {x[0] + v * (x[1] + v * x[2]), x_u[0] + v * (x_u[1] + v * x_u[2]),
          x[1] + 2.0 * v * x[2],        x_uu[0] + v * (x_uu[1] + v * x_uu[2]),
          x_u[1] + 2.0 * v * x_u[2],    2.0 * x[2]};
}

/// Newton's method for |x(u, v) - p|^2 from a start, within the reference domain. Where the Hessian
/// is not positive definite, Gauss and Newton's matrix replaces it. At the domain's border the
/// direction that leads outside is left out.
void QuadraticPiece::improve(const Point<3>& p, double u, double v, Point<3>& best) const {
  constexpr int max_steps = 40;
  constexpr double least_step = 1e-15;
  double best_square = (best - p).squaredNorm();
  const auto move = [&](double& to_u, double& to_v) {
    to_u = std::clamp(to_u, 0.0, 1.0);
    to_v = std::clamp(to_v, 0.0, 1.0);
    if (kind_ == Kind::triangle && to_u + to_v > 1.0) {
      const double excess = 0.5 * (to_u + to_v - 1.0);
      to_u = std::clamp(to_u - excess, 0.0, 1.0);
      to_v = 1.0 - to_u;
    }
  };
  for (int step = 0; step < max_steps; ++step) {
    const Jet jet = at(u, v);
    const Point<3> left = jet.x - p;
    double g_u = left.dot(jet.u), g_v = left.dot(jet.v);
    double h_uu = jet.u.squaredNorm() + left.dot(jet.uu),
           h_uv = jet.u.dot(jet.v) + left.dot(jet.uv),
           h_vv = jet.v.squaredNorm() + left.dot(jet.vv);
    const bool is_line = kind_ == Kind::segment;
    if (!(h_uu > 0.0) || (!is_line && !(h_uu * h_vv - h_uv * h_uv > 0.0))) {
      h_uu = jet.u.squaredNorm();
      h_uv = jet.u.dot(jet.v);
      h_vv = jet.v.squaredNorm();
    }
    double d_u = 0.0, d_v = 0.0;
    const bool u_stays = (u == 0.0 && g_u > 0.0) || (u == 1.0 && g_u < 0.0),
               v_stays = is_line || (v == 0.0 && g_v > 0.0) || (v == 1.0 && g_v < 0.0);
    const bool on_diagonal = kind_ == Kind::triangle && u + v >= 1.0 && g_u + g_v < 0.0;
    if (on_diagonal && !u_stays && !v_stays) {  // along the third side
      const double h = h_uu - 2.0 * h_uv + h_vv;
      if (h > 0.0) d_u = -(g_u - g_v) / h;
      d_v = -d_u;
    } else if (v_stays) {
      if (!u_stays && h_uu > 0.0) d_u = -g_u / h_uu;
    } else if (u_stays) {
      if (h_vv > 0.0) d_v = -g_v / h_vv;
    } else if (const double determinant = h_uu * h_vv - h_uv * h_uv; determinant > 0.0) {
      d_u = -(h_vv * g_u - h_uv * g_v) / determinant;
      d_v = -(h_uu * g_v - h_uv * g_u) / determinant;
    }
    // Halve the step until the distance falls.
    bool has_moved = false;
    for (double part = 1.0; part > 1e-4; part *= 0.5) {
      double to_u = u + part * d_u, to_v = v + part * d_v;
      move(to_u, to_v);
      const Point<3> x = at(to_u, to_v).x;
      const double square = (x - p).squaredNorm();
      if (square < best_square) {
        has_moved = std::abs(to_u - u) + std::abs(to_v - v) > least_step;
        best = x;
        best_square = square;
        u = to_u;
        v = to_v;
        break;
      }
    }
    if (!has_moved) return;
  }
}

Point<3> QuadraticPiece::nearest(const Point<3>& p) const {
  std::array<std::pair<double, std::size_t>, 9> order;
  for (std::size_t k = 0; k < n_starts_; ++k) order[k] = {(starts_[k] - p).squaredNorm(), k};
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(n_starts_));
  constexpr std::size_t n_searches = 3;  // a search along a border may end in a local minimum
  Point<3> nearest = starts_[order[0].second];
  for (std::size_t k = 0; k < std::min(n_searches, n_starts_); ++k) {
    const auto [u, v] = start_at_[order[k].second];
    Point<3> best = starts_[order[k].second];
    improve(p, u, v, best);
    if ((best - p).squaredNorm() < (nearest - p).squaredNorm()) nearest = best;
  }
  return nearest;
}

Point<3> QuadraticPiece::normal_at_side(std::size_t k) const {
  constexpr std::array<std::pair<double, double>, 3> of_triangle{
      {{0.5, 0.0}, {0.5, 0.5}, {0.0, 0.5}}};
  constexpr std::array<std::pair<double, double>, 4> of_quadrilateral{
      {{0.5, 0.0}, {1.0, 0.5}, {0.5, 1.0}, {0.0, 0.5}}};
  const auto [u, v] = kind_ == Kind::triangle ? of_triangle[k] : of_quadrilateral[k];
  const Jet jet = at(u, v);
  return jet.u.cross(jet.v).stableNormalized();
}

}  // namespace smoothfem
