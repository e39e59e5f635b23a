// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/polygons/classification.h"

#include <Eigen/Core>
#include <cmath>

#include "smoothing/polygons/limit_polygons.h"
#include "studies/kinds/polygons/random_polygons.h"

namespace smoothfem {

namespace {

using Matrix = Eigen::MatrixXcd;

/// Returns the matrix of one step about the centroid: the transformation minus the mean of the
/// nodes.
Matrix centred_matrix(std::size_t n, double theta, double lambda) {
  Matrix matrix(n, n);
  for (std::size_t k = 0; k < n; ++k) {
    Polygon unit(n);
    unit[k] = 1.0;
    const Polygon column = transformed(unit, lambda, theta);
    for (std::size_t m = 0; m < n; ++m)
      matrix(static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(k)) =
          column[m] - 1.0 / static_cast<double>(n);
  }
  return matrix;
}

Polygon product(const Matrix& matrix, const Polygon& polygon) {
  const auto n = static_cast<Eigen::Index>(polygon.size());
  Polygon result(polygon.size());
  Eigen::Map<Eigen::VectorXcd>(result.data(), n).noalias() =
      matrix * Eigen::Map<const Eigen::VectorXcd>(polygon.data(), n);
  return result;
}

/// The rotation of nodes against the ones before them. It has n / (2 pi) times the angle, and a
/// likeness: 1 if every node is the one before, turned by the same angle.
struct Symmetry {
  double index, purity;
};
Symmetry symmetry_of(const Polygon& centred) {
  const auto n = static_cast<double>(centred.size());
  Complex turn = 0.0;
  double squares = 0.0;
  for (std::size_t m = 0; m < centred.size(); ++m) {
    turn += centred[(m + 1) % centred.size()] * std::conj(centred[m]);
    squares += std::norm(centred[m]);
  }
  const double index = std::arg(turn) * n / (2.0 * pi);
  return {index < -0.5 ? index + n : index, std::abs(turn) / squares};
}

std::string domain_found(const Polygon& centred, double growth) {
  constexpr double same_growth = 1e-9, pure = 1.0 - 1e-6;
  if (growth < 1.0 - same_growth) return "D_0";
  const auto [index, purity] = symmetry_of(centred);
  if (purity < pure) return "S_" + std::to_string(std::lround(std::floor(index)));
  if (growth < 1.0 + same_growth) return "S_" + std::to_string(std::lround(index) - 1);
  return "D_" + std::to_string(std::lround(index));
}

}  // namespace

ClassificationRow classify_by_iteration(std::size_t n, double theta, double lambda, int doublings,
                                        std::uint64_t seed) {
  const PolygonLimit limit = classify(lambda, theta, n);
  const Matrix step = centred_matrix(n, theta, lambda);
  Matrix power = step;
  for (int i = 0; i < doublings; ++i) {
    const Matrix squared = power * power;
    power = squared / squared.norm();
  }
  SplitMix64 random(seed);
  const Polygon iterated = product(power, random_polygon(n, random));
  const double growth = radius(product(step, iterated)) / radius(iterated);
  return {.n = n,
          .theta = theta,
          .lambda = lambda,
          .predicted = domain_name(limit),
          .iterated = domain_found(iterated, growth),
          .predicted_growth = limit.growth,
          .iterated_growth = growth};
}

}  // namespace smoothfem
