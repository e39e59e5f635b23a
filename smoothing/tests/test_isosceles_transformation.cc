// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "smoothing/polygons/isosceles_transformation.h"
#include "smoothing/tests/polygon_tests.h"

namespace smoothfem {
namespace {

using test::pi;

TEST(IsoscelesStep, HasTheEigenvaluesOfLemma27) {
  for (std::size_t n = 3; n <= test::max_nodes; ++n)
    for (const double theta : {-0.9, 0.0, 0.3, 1.1}) {
      const auto values = isosceles_eigenvalues(theta, n);
      const Eigen::MatrixXcd matrix =
          test::matrix_of(n, [&](const Polygon& z) { return isosceles_step(z, theta); });
      Complex product = 1.0, sum = 0.0;
      for (std::size_t k = 0; k < n; ++k) {
        const Polygon v = eigenpolygon(n, k, 1.0), mv = isosceles_step(v, theta);
        for (std::size_t m = 0; m < n; ++m)
          EXPECT_LT(std::abs(mv[m] - values[k] * v[m]), 1e-13) << n << ' ' << k;
        product *= values[k];
        sum += values[k];
      }
      EXPECT_LT(std::abs(matrix.determinant() - product), 1e-12);
      EXPECT_LT(std::abs(matrix.trace() - sum), 1e-12);
    }
}

TEST(IsoscelesStep, ItsModuliAreRootsOfTheCombinedEigenvalues) {
  for (std::size_t n = 3; n <= test::max_nodes; ++n) {
    const auto one = isosceles_eigenvalues(0.7, n);
    const auto both = eigenvalues(0.5, 0.7, n);
    for (std::size_t k = 0; k < n; ++k) EXPECT_NEAR(std::norm(one[k]), both[k], 1e-14);
  }
}

TEST(IsoscelesStep, BuildsIsoscelesTrianglesOutside) {
  const Polygon square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const Polygon outside = isosceles_step(square, pi / 4.0);
  EXPECT_LT(distance(outside, {{0.5, -0.5}, {1.5, 0.5}, {0.5, 1.5}, {-0.5, 0.5}}), 1e-15);
  test::Random random(6);
  const Polygon z = test::random_polygon(7, random), apices = isosceles_step(z, 0.4);
  for (std::size_t k = 0; k < z.size(); ++k) {
    const Complex base = z[(k + 1) % 7] - z[k];
    EXPECT_NEAR(std::arg((apices[k] - z[k]) / base), -0.4, 1e-13);
    EXPECT_NEAR(std::abs(apices[k] - z[k]), std::abs(apices[k] - z[(k + 1) % 7]), 1e-14);
  }
}

TEST(IsoscelesStep, IteratesFollowTheTurningLimit) {
  test::Random random(7);
  for (std::size_t n = 3; n <= test::max_nodes; ++n)
    for (std::size_t k = 0; k <= n / 2; ++k)
      for (const bool on_line : {false, true}) {
        const double nodes = static_cast<double>(n);
        const double theta = 0.5 * pi / nodes * (on_line ? 2.0 * k + 1.0 : 2.0 * k + 0.3);
        if (theta >= 0.5 * pi) continue;
        const PolygonLimit limit = classify_isosceles(theta, n);
        EXPECT_EQ(limit.dominant.size(), on_line ? 2u : 1u) << n << ' ' << k;
        EXPECT_EQ(limit.dominant.front(), k);
        const Polygon start = test::random_polygon(n, random);
        Polygon z = start;
        std::size_t step = 0;
        const auto go_on = [&] {
          z = scaled_about_centroid(isosceles_step(z, theta), 1.0 / limit.growth);
          ++step;
        };
        while (step < 2000) go_on();
        for (std::size_t i = 0; i < 2 * n; ++i, go_on())
          EXPECT_LT(distance(z, isosceles_limit(start, theta, step)), 1e-9) << n << ' ' << k;
        // Theorem 2.12: two steps later it is the same polygon with its nodes shifted by one
        // number.
        const Polygon now = isosceles_limit(start, theta, step),
                      later = isosceles_limit(start, theta, step + 2);
        for (std::size_t m = 0; m < n; ++m) EXPECT_LT(std::abs(later[m] - now[(m + 1) % n]), 1e-13);
      }
}

TEST(Napoleon, TrianglesAreEquilateralWithTheKnownSide) {
  test::Random random(8);
  for (int i = 0; i < 100; ++i) {
    const Polygon t = test::random_polygon(3, random), equilateral = napoleon_triangle(t);
    double squares = 0.0;
    for (std::size_t k = 0; k < 3; ++k) squares += std::norm(t[(k + 1) % 3] - t[k]);
    const double side = std::sqrt(squares / 6.0 + 2.0 / std::sqrt(3.0) * signed_area(t));
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(std::abs(equilateral[(k + 1) % 3] - equilateral[k]), side, 1e-7);
    EXPECT_GE(signed_area(equilateral), -1e-14);
  }
}

TEST(PetrDouglasNeumann, PolygonsAreRegularWhateverTheirNodes) {
  test::Random random(9);
  for (std::size_t n = 3; n <= test::max_nodes; ++n)
    for (std::size_t k = 1; k < n; ++k) {
      const Polygon z = test::random_polygon(n, random);
      const Polygon result = petr_douglas_neumann_polygon(z, k);
      const Complex middle = centroid(z);
      double largest = 0.0;
      for (const Complex& node : result) largest = std::max(largest, std::abs(node - middle));
      for (std::size_t m = 0; m < n; ++m)
        EXPECT_LT(std::abs(result[(m + 1) % n] - middle -
                           std::exp(Complex(
                               0.0, 2.0 * pi * static_cast<double>(k) / static_cast<double>(n))) *
                               (result[m] - middle)),
                  1e-10 * largest)
            << n << ' ' << k;
    }
}

}  // namespace
}  // namespace smoothfem
