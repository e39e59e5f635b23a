// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <functional>
#include <set>

#include "smoothing/base/input_error.h"
#include "smoothing/polygons/isosceles_transformation.h"
#include "smoothing/tests/polygon_tests.h"

namespace smoothfem {
namespace {

using test::pi;
using Shape = PolygonLimit::Shape;

TEST(Eigenpolygons, AddUpToThePolygonAndAreRegular) {
  test::Random random(1);
  for (std::size_t n = 3; n <= test::max_nodes; ++n) {
    const Polygon z = test::random_polygon(n, random);
    const auto coefficients = eigenpolygon_coefficients(z);
    EXPECT_LT(distance(sum_of_eigenpolygons(coefficients), z), 1e-14) << n;
    Polygon sum(n);
    for (std::size_t k = 0; k < n; ++k) {
      const Polygon v = eigenpolygon(n, k, coefficients[k]);
      const Complex turn =
          std::exp(Complex(0.0, 2.0 * pi * static_cast<double>(k) / static_cast<double>(n)));
      for (std::size_t m = 0; m < n; ++m) {
        sum[m] += v[m];
        EXPECT_LT(std::abs(v[(m + 1) % n] - turn * v[m]), 1e-13) << n << ' ' << k;
      }
    }
    EXPECT_LT(distance(sum, z), 1e-13) << n;
    EXPECT_LT(std::abs(coefficients[0] - centroid(z)), 1e-15) << n;
  }
}

TEST(Eigenpolygons, HaveTheVerticesOfTheorem211) {
  for (std::size_t n = 3; n <= 30; ++n)
    for (std::size_t k = 0; k < n; ++k) {
      // Vertices and their multiplicity, from the exponents of the root of unity.
      std::multiset<std::size_t> exponents;
      for (std::size_t m = 0; m < n; ++m) exponents.insert(m * k % n);
      const StarPolygon star = star_polygon(n, k);
      EXPECT_EQ(std::set(exponents.begin(), exponents.end()).size(), star.vertices);
      for (const std::size_t e : exponents) EXPECT_EQ(exponents.count(e), star.multiplicity);
      const double area = signed_area(eigenpolygon(n, k, 1.0));
      EXPECT_EQ(star.direction, std::abs(area) < 1e-9 ? 0 : area > 0.0 ? 1 : -1) << n << ' ' << k;
      // The sides together turn by 2 pi density multiplicity.
      if (star.vertices < 3) continue;
      const Polygon v = eigenpolygon(n, k, 1.0);
      double turning = 0.0;
      for (std::size_t m = 0; m < n; ++m)
        turning += std::arg((v[(m + 2) % n] - v[(m + 1) % n]) / (v[(m + 1) % n] - v[m]));
      EXPECT_NEAR(turning / (2.0 * pi),
                  star.direction * static_cast<double>(star.density * star.multiplicity), 1e-9);
    }
}

TEST(Eigenvalues, AreThoseOfTheMatrix) {
  test::Random random(2);
  for (std::size_t n = 3; n <= test::max_nodes; ++n) {
    const double lambda = 0.5 + 0.49 * random(), theta = 0.25 * pi * (1.0 + 0.9 * random());
    const auto values = eigenvalues(lambda, theta, n);
    const Eigen::MatrixXcd matrix =
        test::matrix_of(n, [&](const Polygon& z) { return transformed(z, lambda, theta); });
    EXPECT_LT((matrix - matrix.adjoint()).norm(), 1e-12 * matrix.norm()) << "Hermitian";
    const Eigen::VectorXd solved =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd>(matrix).eigenvalues();
    auto sorted = values;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t k = 0; k < n; ++k) {
      EXPECT_NEAR(solved[static_cast<Eigen::Index>(k)], sorted[k], 1e-13 * sorted.back()) << n;
      // Each vector belongs to its eigenpolygon.
      const Polygon v = eigenpolygon(n, k, 1.0), mv = transformed(v, lambda, theta);
      for (std::size_t m = 0; m < n; ++m)
        EXPECT_LT(std::abs(mv[m] - values[k] * v[m]), 1e-12 * sorted.back()) << n << ' ' << k;
    }
    EXPECT_NEAR(values[0], 1.0, 1e-15);
  }
}

TEST(Eigenvalues, AreEqualOnTheirIntersectionLinesOnly) {
  for (std::size_t n = 3; n <= test::max_nodes; ++n)
    for (std::size_t sum = 1; sum < n; ++sum)
      for (const double theta : {0.1, 0.4, 0.9, 1.4}) {
        const double lambda = intersection_line(n, sum, theta);
        if (lambda <= 0.0 || lambda >= 1.0) continue;
        const auto values = eigenvalues(lambda, theta, n);
        const double largest = *std::max_element(values.begin(), values.end());
        for (std::size_t k = 0; k < n; ++k)
          for (std::size_t m = 0; m < k; ++m)
            EXPECT_EQ(std::abs(values[k] - values[m]) < 1e-12 * largest, (k + m) % n == sum)
                << n << ' ' << k << ' ' << m;
      }
}

TEST(Eigenvalues, VanishWhereLemma212Says) {
  for (std::size_t n = 3; n <= test::max_nodes; ++n)
    for (std::size_t k = n / 2 + 1; k < n; ++k) {
      const double root = pi * static_cast<double>(2 * k - n) / static_cast<double>(2 * n);
      const auto values = eigenvalues(0.5, root, n);
      for (std::size_t m = 0; m < n; ++m)
        EXPECT_EQ(values[m] < 1e-25, m == k) << n << ' ' << k << ' ' << m;
    }
}

/// Applies Definition 2.5 with its lines.
std::size_t domain_by_definition(double lambda, double theta, std::size_t n) {
  std::size_t k = 0;
  while (k < n / 2 && lambda < intersection_line(n, 2 * k + 1, theta)) ++k;
  return k;
}

struct ByIteration {
  std::size_t index;  ///< dominant eigenpolygon
  double growth;      ///< in the last step
  double purity;      ///< 1: only that eigenpolygon remains
};

/// Returns the polygon after many scaled steps, from its symmetry: each node is the previous one,
/// turned.
ByIteration iterate(Polygon z, double lambda, double theta, int n_steps) {
  const double n = static_cast<double>(z.size());
  double growth = 0.0;
  for (int i = 0; i < n_steps; ++i) {
    const Complex middle = centroid(z);
    for (Complex& node : z) node -= middle;
    z = scaled_about_centroid(z, 1.0 / radius(z));
    z = transformed(z, lambda, theta);
    growth = radius(z);
  }
  Complex turn = 0.0;
  for (std::size_t m = 0; m < z.size(); ++m) turn += z[(m + 1) % z.size()] * std::conj(z[m]);
  turn /= n * growth * growth;
  const double index = std::fmod(std::arg(turn) * n / (2.0 * pi) + n, n);
  return {static_cast<std::size_t>(std::lround(index)) % z.size(), growth, std::abs(turn)};
}

TEST(Classification, AgreesWithDefinition25AndIteration) {
  test::Random random(3);
  constexpr int grid = 9;
  for (std::size_t n = 3; n <= test::max_nodes; ++n) {
    int n_iterated = 0;
    for (int i = 0; i < grid; ++i)
      for (int j = 0; j < grid; ++j) {
        const double theta = 0.5 * pi * (i + 0.41) / grid, lambda = (j + 0.37) / grid;
        const PolygonLimit limit = classify(lambda, theta, n);
        ASSERT_EQ(limit.dominant.size(), 1u);
        const std::size_t k = limit.dominant.front();
        EXPECT_EQ(k, domain_by_definition(lambda, theta, n)) << n << ' ' << theta << ' ' << lambda;
        const auto values = eigenvalues(lambda, theta, n);
        EXPECT_EQ(k, static_cast<std::size_t>(std::max_element(values.begin(), values.end()) -
                                              values.begin()));
        if (limit.convergence > 0.985) continue;  // too near a line for this many steps
        ++n_iterated;
        const auto found = iterate(test::random_polygon(n, random), lambda, theta, 1500);
        EXPECT_EQ(found.growth < 1.0, k == 0) << n << ' ' << theta << ' ' << lambda;
        if (k == 0) continue;
        EXPECT_EQ(found.index, k) << n << ' ' << theta << ' ' << lambda;
        EXPECT_NEAR(found.growth, limit.growth, 1e-8 * limit.growth);
        EXPECT_NEAR(found.purity, 1.0, 1e-8);
      }
    EXPECT_GT(n_iterated, grid * grid / 2) << n;
  }
}

TEST(Classification, FindsTheIntersectionLines) {
  test::Random random(4);
  for (std::size_t n = 3; n <= test::max_nodes; ++n)
    for (std::size_t k = 0; k < n / 2; ++k)
      for (const double theta : {0.2, 0.7, 1.3}) {
        const double lambda = intersection_line(n, 2 * k + 1, theta);
        if (lambda <= 0.01 || lambda >= 0.99) continue;
        const PolygonLimit limit = classify(lambda, theta, n);
        EXPECT_EQ(limit.dominant, (std::vector<std::size_t>{k, k + 1})) << n << ' ' << theta;
        EXPECT_EQ(limit.shape, k == 0 ? Shape::regular : Shape::combination);
        EXPECT_EQ(domain_name(limit), "S_" + std::to_string(k));
        EXPECT_EQ(domain_name(classify(lambda + 1e-6, theta, n)), "D_" + std::to_string(k));
        EXPECT_EQ(domain_name(classify(lambda - 1e-6, theta, n)), "D_" + std::to_string(k + 1));
        // The sum of both eigenpolygons keeps its shape, up to the growth.
        const Polygon sum = limit_polygon(test::random_polygon(n, random), limit);
        EXPECT_LT(
            distance(transformed(sum, lambda, theta), scaled_about_centroid(sum, limit.growth)),
            1e-11 * limit.growth);
      }
}

TEST(Classification, ScaledIteratesTendToTheLimitPolygon) {
  test::Random random(5);
  for (std::size_t n = 3; n <= test::max_nodes; ++n)
    for (const double lambda : {0.3, 0.5, 0.8})
      for (const double theta : {0.1, 0.6, 1.2}) {
        const PolygonLimit limit = classify(lambda, theta, n);
        Polygon z = test::random_polygon(n, random);
        const Polygon expected = limit_polygon(z, limit);
        for (int i = 0; i < 20000; ++i)
          z = scaled_about_centroid(transformed(z, lambda, theta), 1.0 / limit.growth);
        EXPECT_LT(distance(z, expected), 1e-8) << n << ' ' << lambda << ' ' << theta;
      }
}

TEST(Classification, NamesTheShapes) {
  // Isosceles triangles with the angle in the middle of each interval of Lemma 2.10.
  const std::vector<std::vector<Shape>> shapes{
      {Shape::point, Shape::regular},
      {Shape::point, Shape::regular, Shape::segment},
      {Shape::point, Shape::regular, Shape::star},
      {Shape::point, Shape::regular, Shape::regular, Shape::segment}};
  for (std::size_t n = 3; n <= 6; ++n)
    for (std::size_t k = 0; k <= n / 2; ++k) {
      const double nodes = static_cast<double>(n);
      const double from = std::max(0.0, (2.0 * k - 1.0) / nodes),
                   to = std::min(1.0, (2.0 * k + 1.0) / nodes);
      const PolygonLimit limit = classify_isosceles(0.25 * pi * (from + to), n);
      EXPECT_EQ(limit.shape, shapes[n - 3][k]) << n << ' ' << k;
      EXPECT_EQ(limit.dominant, std::vector<std::size_t>{k});
    }
  EXPECT_EQ(star_polygon(6, 2).multiplicity, 2u);
  EXPECT_EQ(star_polygon(6, 4).direction, -1);
  EXPECT_EQ(star_polygon(5, 2).density, 2u);
}

TEST(Classification, RefusesParametersOutOfRange) {
  for (const double bad : {0.0, 1.0, -1.0, std::nan("")})
    EXPECT_THROW(classify(bad, 0.5, 4), InputError) << bad;
  for (const double bad : {0.0, 0.5 * pi + 1e-9, -1.0, std::nan("")})
    EXPECT_THROW(classify(0.5, bad, 4), InputError) << bad;
  EXPECT_THROW(classify(0.5, 0.5, 2), InputError);
}

}  // namespace
}  // namespace smoothfem
