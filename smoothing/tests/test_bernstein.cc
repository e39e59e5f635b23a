// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "smoothing/second_order/bernstein.h"
#include "smoothing/tests/planar_meshes.h"

namespace smoothfem {
namespace {

/// The spaces of all types of cells.
std::vector<std::vector<BernsteinFactor>> spaces() {
  return {{{2, 2}}, {{2, 4}},         {{1, 3}, {1, 3}},         {{3, 3}},
          {{1, 5}}, {{2, 4}, {1, 5}}, {{1, 5}, {1, 5}, {1, 3}}, {{1, 5}, {1, 5}, {1, 5}}};
}

/// A polynomial of the space: the product of a power of a linear function for each factor.
double polynomial(const std::vector<BernsteinFactor>& factors, const Point<3>& x) {
  constexpr double slopes[] = {0.7, -1.3, 0.4};
  double product = 1.0;
  int d = 0;
  for (const auto& [dim, degree] : factors) {
    double linear = 0.6;
    for (int i = 0; i < dim; ++i, ++d) linear += slopes[d] * x[d];
    product *= std::pow(linear, degree);
  }
  return product;
}

std::vector<double> polynomial_coefficients(const std::vector<BernsteinFactor>& factors,
                                            const BernsteinSpace& space) {
  std::vector<double> coefficients;
  for (const auto& x : space.points()) coefficients.push_back(polynomial(factors, x));
  space.to_coefficients(coefficients);
  return coefficients;
}

/// A random point of the domain.
Point<3> random_point(const std::vector<BernsteinFactor>& factors, test::Random& random) {
  Point<3> x = Point<3>::Zero();
  int d = 0;
  for (const auto& factor : factors) {
    const int first = d;
    do
      for (d = first; d < first + factor.dim; ++d) x[d] = 0.5 + 0.5 * random();
    while (x.segment(first, factor.dim).sum() > 1.0);
  }
  return x;
}

TEST(Bernstein, CoefficientsGiveTheValuesOfThePolynomial) {
  test::Random random(1);
  for (const auto& factors : spaces()) {
    const BernsteinSpace space(factors);
    const auto coefficients = polynomial_coefficients(factors, space);
    for (int i = 0; i < 20; ++i) {
      const Point<3> x = random_point(factors, random);
      EXPECT_NEAR(space.value(coefficients, x), polynomial(factors, x), 1e-12);
    }
    for (std::size_t i = 0; i < space.size(); ++i)
      EXPECT_NEAR(space.value(coefficients, space.points()[i]),
                  polynomial(factors, space.points()[i]), 1e-12);
  }
}

TEST(Bernstein, CoefficientsAtCornersAreValues) {
  constexpr std::size_t n_corners[] = {3, 3, 4, 4, 2, 6, 8, 8};
  std::size_t s = 0;
  for (const auto& factors : spaces()) {
    const BernsteinSpace space(factors);
    const auto coefficients = polynomial_coefficients(factors, space);
    EXPECT_EQ(space.corners().size(), n_corners[s++]);
    for (const std::size_t corner : space.corners()) {
      const Point<3>& x = space.points()[corner];
      for (int d = 0; d < 3; ++d) EXPECT_TRUE(x[d] == 0.0 || x[d] == 1.0);
      EXPECT_NEAR(coefficients[corner], polynomial(factors, x), 1e-13);
    }
  }
}

/// Powers of a line's coordinate have known coefficients: those of x^2 in degree 5 are
/// i (i-1) / 20.
TEST(Bernstein, CoefficientsOfASquareAreTheKnownOnes) {
  const BernsteinSpace space({{1, 5}});
  std::vector<double> coefficients;
  for (const auto& x : space.points()) coefficients.push_back(x[0] * x[0]);
  space.to_coefficients(coefficients);
  for (int i = 0; i <= 5; ++i) EXPECT_NEAR(coefficients[i], i * (i - 1) / 20.0, 1e-14);
}

/// Values of +1 and -1 with the worst signs reach the bound.
TEST(Bernstein, ConversionNormIsThatOfTheWorstValues) {
  for (const auto& factors : spaces()) {
    const BernsteinSpace space(factors);
    std::vector<double> sums(space.size(), 0.0);
    for (std::size_t j = 0; j < space.size(); ++j) {
      std::vector<double> unit(space.size(), 0.0);
      unit[j] = 1.0;
      space.to_coefficients(unit);
      for (std::size_t i = 0; i < space.size(); ++i) sums[i] += std::abs(unit[i]);
    }
    EXPECT_NEAR(*std::max_element(sums.begin(), sums.end()) / space.conversion_norm(), 1.0, 1e-12);
  }
}

/// Half 1 has a vertex of the factor moved to the middle of the edge; half 2 has the other one.
TEST(Bernstein, BisectionKeepsThePolynomial) {
  test::Random random(2);
  for (const auto& factors : spaces()) {
    const BernsteinSpace space(factors);
    const auto coefficients = polynomial_coefficients(factors, space);
    std::size_t s = 0;
    int first_coordinate = 0;
    for (const auto& [dim, degree] : factors) {
      for (int b = 1; b <= dim; ++b)
        for (int a = 0; a < b; ++a) {
          std::vector<double> first = coefficients, second(space.size());
          space.bisect(space.splits().at(s++), first, first, second);
          for (int i = 0; i < 20; ++i) {
            const Point<3> x = random_point(factors, random);
            Eigen::Vector4d barycentric = Eigen::Vector4d::Zero();
            for (int d = 0; d < dim; ++d) barycentric[d + 1] = x[first_coordinate + d];
            barycentric[0] = 1.0 - barycentric.sum();
            const auto in_whole = [&](int from, int to) {
              Eigen::Vector4d moved = barycentric;
              moved[to] += 0.5 * barycentric[from];
              moved[from] *= 0.5;
              Point<3> y = x;
              for (int d = 0; d < dim; ++d) y[first_coordinate + d] = moved[d + 1];
              return polynomial(factors, y);
            };
            EXPECT_NEAR(space.value(first, x), in_whole(b, a), 1e-12);
            EXPECT_NEAR(space.value(second, x), in_whole(a, b), 1e-12);
          }
        }
      first_coordinate += dim;
    }
    EXPECT_EQ(s, space.splits().size());
  }
}

TEST(Bernstein, BestSplitCutsTheDirectionThatBends) {
  const BernsteinSpace space({{1, 5}, {1, 5}, {1, 3}});
  for (int d = 0; d < 3; ++d) {
    std::vector<double> values;
    for (const auto& x : space.points()) values.push_back(x[d] * x[d] + x.sum());
    space.to_coefficients(values);
    EXPECT_EQ(&space.best_split(values), &space.splits()[static_cast<std::size_t>(d)]);
  }
}

}  // namespace
}  // namespace smoothfem
