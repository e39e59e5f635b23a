// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/second_order/bernstein.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "smoothing/simd/lanes.h"

namespace smoothfem {

namespace {

constexpr std::size_t max_size_of_factor = 20;
constexpr std::size_t max_line = 6;

/// Lists the multi-indices with sum `degree`; those of vertices beyond dim are 0.
std::vector<std::array<int, 4>> multi_indices(BernsteinFactor shape) {
  std::vector<std::array<int, 4>> all;
  for (int c = 0; c <= (shape.dim > 2 ? shape.degree : 0); ++c)
    for (int b = 0; b <= (shape.dim > 1 ? shape.degree - c : 0); ++b)
      for (int a = 0; a <= shape.degree - b - c; ++a)
        all.push_back({shape.degree - a - b - c, a, b, c});
  return all;
}

/// The point of a multi-index. Points of a line are dense at its ends (Chebyshev), so that the
/// conversion is less sensitive to rounding errors.
Point<3> factor_point(BernsteinFactor shape, const std::array<int, 4>& index) {
  Point<3> point(index[1], index[2], index[3]);
  point /= shape.degree;
  if (shape.dim == 1 && index[0] > 0 && index[1] > 0)
    point[0] = 0.5 - 0.5 * std::cos(std::numbers::pi * point[0]);
  return point;
}

/// Barycentric coordinates of the point with these coordinates.
template <class Real>
std::array<Real, 4> barycentric(int dim, const double* coordinates) {
  std::array<Real, 4> result{1};
  for (int d = 0; d < dim; ++d) {
    result[static_cast<std::size_t>(d) + 1] = coordinates[d];
    result[0] -= coordinates[d];
  }
  return result;
}

/// Basis function of a multi-index at barycentric coordinates.
template <class Real>
Real basis_function(const std::array<int, 4>& index, const std::array<Real, 4>& barycentric) {
  Real result = 1;
  int n = 0;  // the multinomial coefficient grows by one factor with each power
  for (std::size_t v = 0; v < 4; ++v)
    for (int i = 1; i <= index[v]; ++i) result *= barycentric[v] * (++n) / i;
  return result;
}

}  // namespace

BernsteinSpace::Factor BernsteinSpace::make_factor(BernsteinFactor shape, std::size_t stride) {
  using Real = long double;  // entries are rounded once
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  Factor factor{shape, multi_indices(shape), {}, 0, stride};
  const auto n = static_cast<Eigen::Index>(factor.indices.size());
  Matrix values(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Point<3> point = factor_point(shape, factor.indices[static_cast<std::size_t>(i)]);
    for (Eigen::Index j = 0; j < n; ++j)
      values(i, j) = basis_function(factor.indices[static_cast<std::size_t>(j)],
                                    barycentric<Real>(shape.dim, point.data()));
  }
  const Matrix inverse = values.inverse();
  factor.row = (factor.indices.size() + n_lanes - 1) / n_lanes * n_lanes;
  factor.conversion.assign(factor.indices.size() * factor.row, 0.0);
  for (Eigen::Index j = 0; j < n; ++j)
    std::copy_n(inverse.data() + j * n, n,
                factor.conversion.begin() + j * static_cast<Eigen::Index>(factor.row));
  return factor;
}

BernsteinSpace::BernsteinSpace(std::vector<BernsteinFactor> factors) {
  points_ = {Point<3>::Zero()};
  corners_ = {0};
  int first_coordinate = 0;
  std::size_t n_terms = 0;
  for (const BernsteinFactor& shape : factors) {
    const std::size_t stride = points_.size();
    const Factor& factor = factors_.emplace_back(make_factor(shape, stride));
    const std::size_t n = factor.indices.size();
    std::vector<Point<3>> points;
    std::vector<std::size_t> corners;
    for (std::size_t i = 0; i < n; ++i) {
      const auto& index = factor.indices[i];
      for (Point<3> point : points_) {
        point.segment(first_coordinate, shape.dim) = factor_point(shape, index).head(shape.dim);
        points.push_back(point);
      }
      if (*std::max_element(index.begin(), index.end()) == shape.degree)
        for (const std::size_t corner : corners_) corners.push_back(corner + i * stride);
    }
    points_ = std::move(points);
    corners_ = std::move(corners);
    first_coordinate += shape.dim;

    double norm = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < n; ++j) sum += std::abs(factor.conversion[j * factor.row + i]);
      norm = std::max(norm, sum);
    }
    conversion_norm_ *= norm;
    n_terms += n + 1;
  }
  conversion_error_ = 1.1 * static_cast<double>(n_terms) * 0x1p-53 * conversion_norm_;
  for (const Factor& factor : factors_) add_splits(factor);
}

void BernsteinSpace::add_splits(const Factor& factor) {
  const auto& indices = factor.indices;
  const auto position = [&](const std::array<int, 4>& index) {
    return static_cast<std::size_t>(std::find(indices.begin(), indices.end(), index) -
                                    indices.begin());
  };
  const auto n_vertices = static_cast<std::size_t>(factor.shape.dim) + 1;
  const std::size_t period = factor.stride * indices.size();
  for (std::size_t b = 1; b < n_vertices; ++b)
    for (std::size_t a = 0; a < b; ++a) {
      Split split;
      for (std::size_t start = 0; start < size(); start += period)
        for (std::array<int, 4> index : indices) {
          if (index[b] != 0) continue;
          std::vector<std::size_t> in_factor{position(index)};
          while (index[a] > 0) {
            --index[a];
            ++index[b];
            in_factor.push_back(position(index));
          }
          for (std::size_t offset = start; offset < start + factor.stride; ++offset) {
            std::vector<std::uint32_t> line;
            for (const std::size_t i : in_factor)
              line.push_back(static_cast<std::uint32_t>(offset + i * factor.stride));
            split.append(line);
          }
        }
      splits_.push_back(std::move(split));
    }
}

void BernsteinSpace::to_coefficients(std::span<double> values) const {
  for (const Factor& factor : factors_) {
    const std::size_t n = factor.indices.size(), stride = factor.stride;
    for (std::size_t start = 0; start < size(); start += n * stride)
      for (std::size_t offset = start; offset < start + stride; ++offset) {
        double* const column = values.data() + offset;
        std::array<double, max_size_of_factor> of_column;
        for (std::size_t j = 0; j < n; ++j) of_column[j] = column[j * stride];
        for (std::size_t first = 0; first < n; first += n_lanes) {
          Lanes sums{};
          for (std::size_t j = 0; j < n; ++j)
            sums += load_lanes(factor.conversion.data() + j * factor.row + first) * of_column[j];
          for (std::size_t i = first; i < std::min(first + n_lanes, n); ++i)
            column[i * stride] = sums[i - first];
        }
      }
  }
}

double BernsteinSpace::value(std::span<const double> coefficients, const Point<3>& x) const {
  double sum = 0.0;
  for (std::size_t c = 0; c < size(); ++c) {
    double product = coefficients[c];
    int first_coordinate = 0;
    for (const Factor& factor : factors_) {
      const auto& index = factor.indices[c / factor.stride % factor.indices.size()];
      product *=
          basis_function(index, barycentric<double>(factor.shape.dim, x.data() + first_coordinate));
      first_coordinate += factor.shape.dim;
    }
    sum += product;
  }
  return sum;
}

void BernsteinSpace::bisect(const Split& split, std::span<const double> coefficients,
                            std::span<double> first, std::span<double> second) const {
  for (std::size_t l = 0; l < split.size(); ++l) {
    const auto line = split[l];
    const std::size_t n = line.size();
    std::array<double, max_line> means;
    for (std::size_t i = 0; i < n; ++i) means[i] = coefficients[line[i]];
    for (std::size_t step = 0; step < n; ++step) {
      first[line[step]] = means[0];
      second[line[n - 1 - step]] = means[n - 1 - step];
      for (std::size_t i = 0; i + 1 < n - step; ++i) means[i] = 0.5 * (means[i] + means[i + 1]);
    }
  }
}

int BernsteinSpace::bisection_steps() const {
  int most = 0;
  for (const Factor& factor : factors_) most = std::max(most, factor.shape.degree);
  return most;
}

const BernsteinSpace::Split& BernsteinSpace::best_split(
    std::span<const double> coefficients) const {
  const Split* best = &splits_.front();
  double largest = 0.0;
  for (const Split& split : splits_) {
    double deviation = 0.0;
    for (std::size_t l = 0; l < split.size(); ++l) {
      const auto line = split[l];
      for (std::size_t i = 2; i < line.size(); ++i)
        deviation =
            std::max(deviation, std::abs(coefficients[line[i - 2]] -
                                         2.0 * coefficients[line[i - 1]] + coefficients[line[i]]));
    }
    if (deviation > largest) {
      largest = deviation;
      best = &split;
    }
  }
  return *best;
}

}  // namespace smoothfem
