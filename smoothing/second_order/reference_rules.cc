// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/second_order/reference_rules.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "smoothing/mesh/midside_nodes.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/simd/cells.h"

namespace smoothfem {

namespace {

/// A point of a line or of a triangle in two coordinates, and its weight.
struct LinePoint {
  double x, weight;
};

constexpr std::array<LinePoint, 3> simpson{{{0.0, 1.0 / 6.0}, {0.5, 4.0 / 6.0}, {1.0, 1.0 / 6.0}}};

/// Radau's rule on [0, 1] with the point 0, for the weight 3 (1-z)^2; exact for degree 4.
std::array<LinePoint, 3> radau() {
  const double a = (3.0 - std::numbers::sqrt2) / 7.0, b = (3.0 + std::numbers::sqrt2) / 7.0;
  // The weighted means of z and z^2 are 1/4 and 1/10.
  const double of_a = (0.25 * b - 0.1) / (a * (b - a)), of_b = (0.1 - 0.25 * a) / (b * (b - a));
  return {{{0.0, 1.0 - of_a - of_b}, {a, of_a}, {b, of_b}}};
}

std::vector<WeightedPoint> triangle_rule() {
  return {{{0.0, 0.0, 0.0}, 0.05},
          {{1.0, 0.0, 0.0}, 0.05},
          {{0.0, 1.0, 0.0}, 0.05},
          {{0.5, 0.0, 0.0}, 2.0 / 15.0},
          {{0.5, 0.5, 0.0}, 2.0 / 15.0},
          {{0.0, 0.5, 0.0}, 2.0 / 15.0},
          {{1.0 / 3.0, 1.0 / 3.0, 0.0}, 0.45}};
}

std::vector<WeightedPoint> quadrilateral_rule() {
  std::vector<WeightedPoint> rule;
  for (const auto& [y, of_y] : simpson)
    for (const auto& [x, of_x] : simpson) rule.push_back({{x, y, 0.0}, of_x * of_y});
  return rule;
}

std::vector<WeightedPoint> tetrahedron_rule() {
  constexpr double third = 1.0 / 3.0;
  std::vector<WeightedPoint> rule{{{0.0, 0.0, 0.0}, 0.025}, {{third, third, third}, 0.225}};
  for (int d = 0; d < 3; ++d) {
    rule.push_back({Point<3>::Unit(d), 0.025});
    rule.push_back({third * (Point<3>::Ones() - Point<3>::Unit(d)), 0.225});
  }
  return rule;
}

/// Returns a planar rule times one in z. squeeze(z): width of the cell at z.
template <class Squeeze>
std::vector<WeightedPoint> product(const std::vector<WeightedPoint>& planar,
                                   const std::array<LinePoint, 3>& line, const Squeeze& squeeze) {
  std::vector<WeightedPoint> rule;
  for (const auto& [z, of_z] : line)
    for (const auto& [x, weight] : planar)
      rule.push_back({{squeeze(z) * x[0], squeeze(z) * x[1], z}, of_z * weight});
  return rule;
}

/// Returns (W^-1)' for the ideal cell: columns of W are its edges from the first corner along the
/// axes of the reference element. In the plane these lead to the next and the previous corner.
template <int dim>
Eigen::Matrix<double, dim, dim> to_ideal(std::size_t n_corners) {
  Eigen::Matrix<double, dim, dim> result;
  if constexpr (dim == 2) {
    const auto [sine, cosine] = regular_interior_angle(n_corners);
    result << 1.0, 0.0, -cosine / sine, 1.0 / sine;
  } else {
    with_cell_size<3>(n_corners, [&](auto n) {
      if constexpr (n > 0) {
        Eigen::Matrix3d inverse_gram;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            inverse_gram(i, j) = VolumeElement<n>::regular.inverse_gram[i][j];
        // W^-1 (W^-1)' = L L' determines W^-1 = L up to a rotation.
        result = Eigen::Matrix3d(inverse_gram.llt().matrixL()).transpose();
      }
    });
  }
  return result;
}

/// The corner of a linear cell and its neighbours along the columns of W.
template <int dim>
using LinearCorner = std::array<std::size_t, dim + 1>;

/// Returns the corners that the mean ratio counts.
template <int dim>
std::vector<LinearCorner<dim>> counted_corners(std::size_t n) {
  std::vector<LinearCorner<dim>> corners;
  if constexpr (dim == 2) {
    for (std::size_t k = 0; k < (n == 3 ? 1 : n); ++k)
      corners.push_back({k, k + 1 == n ? 0 : k + 1, k == 0 ? n - 1 : k - 1});
  } else {
    for (const LocalSimplex& corner : volume_element(n).corners)
      corners.push_back({corner[0], corner[1], corner[2], corner[3]});
  }
  return corners;
}

}  // namespace

std::vector<WeightedPoint> reference_rule(int dim, std::size_t n_corners) {
  const auto constant = [](double) { return 1.0; };
  if (dim == 2) return n_corners == 3 ? triangle_rule() : quadrilateral_rule();
  switch (n_corners) {
    case 4:
      return tetrahedron_rule();
    case 5:
      return product(quadrilateral_rule(), radau(), [](double z) { return 1.0 - z; });
    case 6:
      return product(triangle_rule(), simpson, constant);
    default:
      return product(quadrilateral_rule(), simpson, constant);
  }
}

template <int dim>
CellRule<dim>::CellRule(std::size_t n_corners, std::size_t n_midside)
    : n_nodes_(n_corners + n_midside), mean_gradients_(n_nodes_, Point<dim>::Zero()) {
  const Eigen::Matrix<double, dim, dim> map = to_ideal<dim>(n_corners);
  std::vector<Point<dim>> gradients(n_nodes_);
  if (n_midside > 0) {
    for (const auto& [x, weight] : reference_rule(dim, n_corners)) {
      const auto of_reference = shape_functions(dim, n_nodes_).gradients(x);
      for (std::size_t i = 0; i < n_nodes_; ++i)
        gradients[i] = map * of_reference[i].template head<dim>();
      add_point(weight, gradients);
    }
  } else {
    const auto corners = counted_corners<dim>(n_corners);
    for (const auto& corner : corners) {
      std::fill(gradients.begin(), gradients.end(), Point<dim>::Zero());
      for (int d = 0; d < dim; ++d) {
        gradients[corner[d + 1]] = map.col(d);
        gradients[corner[0]] -= map.col(d);
      }
      add_point(1.0 / static_cast<double>(corners.size()), gradients);
    }
  }
  if (n_midside > 0) set_bending(n_corners);
  fill_group();
}

template <int dim>
void CellRule<dim>::add_point(double weight, const std::vector<Point<dim>>& gradients) {
  const std::size_t group = n_points_ / n_lanes, l = n_points_ % n_lanes;
  if (l == 0) {
    weights_.resize((group + 1) * n_lanes);
    gradients_.resize((group + 1) * n_lanes * n_nodes_ * dim);
  }
  weights_[n_points_++] = weight;
  for (std::size_t i = 0; i < n_nodes_; ++i) {
    mean_gradients_[i] += weight * gradients[i];
    for (std::size_t d = 0; d < dim; ++d)
      gradients_[n_lanes * ((group * n_nodes_ + i) * dim + d) + l] = gradients[i][d];
  }
}

/// With midside nodes m and the corners c of their places, S - S' is the sum over m of
/// (x_m - mean_c x_c) grad N_m'.
template <int dim>
void CellRule<dim>::set_bending(std::size_t n_corners) {
  Eigen::MatrixXd from_straight =  // of midside nodes, by all nodes
      Eigen::MatrixXd::Identity(static_cast<Eigen::Index>(n_nodes_),
                                static_cast<Eigen::Index>(n_nodes_));
  std::vector<NodeIndex> nodes(n_nodes_);
  std::iota(nodes.begin(), nodes.end(), NodeIndex{0});
  const auto corners = std::span<const NodeIndex>(nodes).first(n_corners);
  for (const NodeIndex c : corners) from_straight(c, c) = 0.0;
  for_each_midside_place(dim, corners, std::span<const NodeIndex>(nodes).subspan(n_corners),
                         [&](const MidsidePlace& place, NodeIndex node) {
                           const auto end = std::find(place.begin(), place.end(), no_corner);
                           const bool is_in_hexahedron = place[0] == place[1];
                           const auto around = is_in_hexahedron
                                                   ? corners
                                                   : std::span<const NodeIndex>(place.begin(), end);
                           for (const NodeIndex c : around)
                             from_straight(node, c) = -1.0 / static_cast<double>(around.size());
                         });
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(from_straight.rows(), from_straight.cols());
  for (std::size_t k = 0; k < n_points_; ++k)
    for (std::size_t p = n_corners; p < n_nodes_; ++p)
      for (std::size_t q = n_corners; q < n_nodes_; ++q)
        for (std::size_t d = 0; d < dim; ++d) {
          const auto of = [&](std::size_t i) {
            return gradients_[n_lanes * ((k / n_lanes * n_nodes_ + i) * dim + d) + k % n_lanes];
          };
          products(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(q)) +=
              weights_[k] * of(p) * of(q);
        }
  const Eigen::MatrixXd bending = from_straight.transpose() * products * from_straight;
  bending_.assign(bending.data(), bending.data() + bending.size());
}

/// Repeats the last point without weight.
template <int dim>
void CellRule<dim>::fill_group() {
  const std::size_t group = n_points_ / n_lanes, l = n_points_ % n_lanes;
  if (l == 0) return;
  double* const numbers = gradients_.data() + n_lanes * group * n_nodes_ * dim;
  for (std::size_t k = 0; k < n_nodes_ * dim; ++k)
    std::fill(numbers + n_lanes * k + l, numbers + n_lanes * (k + 1), numbers[n_lanes * k + l - 1]);
}

template class CellRule<2>;
template class CellRule<3>;

}  // namespace smoothfem
