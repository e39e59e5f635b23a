// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "smoothing/polygons/isosceles_transformation.h"
#include "smoothing/polygons/triangle_transformations.h"
#include "smoothing/tests/polygon_tests.h"

namespace smoothfem {
namespace {

using test::pi;
constexpr int n_triangles = 200;

/// Visits random triangles, with angles from all of (0, pi/2).
template <class Visit>
void for_random_triangles(const Visit& visit) {
  test::Random random(1);
  for (int i = 0; i < n_triangles; ++i) {
    const Polygon triangle = test::random_triangle(random);
    visit(triangle, 0.25 * pi * (1.0 + 0.95 * random()));
  }
}

double squared(double value) {
  return value * value;
}

TEST(TriangleTransformation, SidesAreThoseOfLemma21) {
  for_random_triangles([](const Polygon& triangle, double theta) {
    const auto [x, y, z] = sides_of(triangle);
    const double t = std::tan(theta), area = signed_area(triangle);
    const TriangleSides next = sides_of(equilateral_step(triangle, theta));
    EXPECT_NEAR(squared(next.x),
                0.5 * t * t * (y * y + z * z) + 0.25 * (1.0 - t * t) * x * x + 2.0 * t * area,
                1e-13 * (1.0 + t * t));
    EXPECT_NEAR(squared(next.x) - squared(next.y), 0.25 * (1.0 - 3.0 * t * t) * (x * x - y * y),
                1e-13 * (1.0 + t * t));
  });
}

TEST(TriangleTransformation, RightIsoscelesSidesAreThoseOfLemma25) {
  for_random_triangles([](const Polygon& triangle, double theta) {
    const auto [x, y, z] = sides_of(triangle);
    const double t = std::tan(theta), area = signed_area(triangle);
    const TriangleSides next = sides_of(right_isosceles_step(triangle, theta));
    const double tolerance = 1e-13 * (1.0 + t * t);
    EXPECT_NEAR(squared(next.y), 0.25 * y * y + 0.25 * t * t * z * z + t * area, tolerance);
    EXPECT_NEAR(squared(next.y) - squared(next.z), 0.25 * (1.0 - t * t) * (y * y - z * z),
                tolerance);
    // Printed in the thesis with a plus before the last z (2.8).
    EXPECT_NEAR(squared(next.x) - squared(next.y) - squared(next.z),
                0.25 * (1.0 - t * t) * (x * x - y * y - z * z), tolerance);
  });
}

TEST(TriangleTransformation, IsTheStepOfPolygons) {
  for_random_triangles([](const Polygon& triangle, double theta) {
    const Polygon a = equilateral_step(triangle, theta), b = isosceles_step(triangle, theta);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(std::abs(a[k] - b[(k + 1) % 3]), 1e-15);
  });
}

/// Checks Proposition 2.1 and similar ones: the defect after two steps is at most `factor` times
/// the defect before.
template <class Step, class Defect>
void expect_shrinking(const Polygon& start, double theta, double factor, const Step& step,
                      const Defect& defect) {
  EXPECT_GE(factor, 0.0);
  EXPECT_LT(factor, 1.0);
  Polygon triangle = start;
  for (int i = 0; i < 8; ++i) {
    const Polygon next = step(step(triangle, theta), theta);
    EXPECT_LE(defect(next), factor * defect(triangle) + 1e-13) << theta;
    triangle = scaled_about_centroid(next, 1.0 / radius(next));
  }
}

TEST(TriangleTransformation, SideRatiosTendToOneAsProposition21Says) {
  for_random_triangles([](const Polygon& triangle, double theta) {
    expect_shrinking(triangle, theta, equilateral_convergence_factor(theta), equilateral_step,
                     [](const Polygon& p) {
                       const auto [x, y, z] = sides_of(p);
                       return 1.0 - std::min(x, y) / std::max(x, y);
                     });
  });
}

/// Proposition 2.2 promises one factor below 1 for all triangles, theta = pi/4 included. Up to
/// there, the factor tends to (3 t^2 - 1) / (1 + t^2) for triangles with ever shorter third sides:
/// to 1.
TEST(TriangleTransformation, OneStepNeedNotShrinkSideRatiosByAFixedFactorAt45Degrees) {
  const auto worst = [](double theta, double z) {
    double largest = 0.0;
    for (int i = 1; i < 400; ++i) {
      const Polygon triangle{0.0, std::polar(z, -pi * i / 400.0), 1.0};
      const TriangleSides before = sides_of(triangle),
                          after = sides_of(equilateral_step(triangle, theta));
      const double defect = 1.0 - std::min(before.x, before.y) / std::max(before.x, before.y);
      if (defect < 1e-6) continue;
      largest = std::max(largest,
                         (1.0 - std::min(after.x, after.y) / std::max(after.x, after.y)) / defect);
    }
    return largest;
  };
  for (const double z : {0.1, 0.01, 0.001}) {
    EXPECT_GT(worst(pi / 4.0, z), 1.0 - 0.15 * z) << z;
    EXPECT_LT(worst(pi / 4.0, z), 1.0) << z;
  }
  const double t = std::tan(0.6);
  EXPECT_NEAR(worst(0.6, 1e-3), (3.0 * t * t - 1.0) / (1.0 + t * t), 1e-3);
}

TEST(TriangleTransformation, RightIsoscelesDefectsShrinkAsPropositions23And24Say) {
  for_random_triangles([](const Polygon& triangle, double theta) {
    const double factor = right_isosceles_convergence_factor(theta);
    expect_shrinking(triangle, theta, factor, right_isosceles_step, [](const Polygon& p) {
      const auto [x, y, z] = sides_of(p);
      return 1.0 - std::min(y, z) / std::max(y, z);
    });
    expect_shrinking(triangle, theta, factor, right_isosceles_step, [](const Polygon& p) {
      const auto [x, y, z] = sides_of(p);
      return std::abs(1.0 - (y * y + z * z) / (x * x));
    });
  });
}

TEST(TriangleTransformation, FactorsVanishForTheAnglesThatNeedOneStep) {
  EXPECT_LT(equilateral_convergence_factor(pi / 6.0), 1e-30);
  EXPECT_LT(right_isosceles_convergence_factor(pi / 4.0), 1e-30);
  EXPECT_NEAR(equilateral_growth(pi / 6.0), 1.0, 1e-15);
  EXPECT_NEAR(right_isosceles_growth(pi / 4.0), 1.0, 1e-15);
}

template <class Step>
Polygon limit_of(Polygon triangle, double theta, double growth, const Step& step) {
  for (int i = 0; i < 2000; ++i)
    triangle = scaled_about_centroid(step(triangle, theta), 1.0 / growth);
  return triangle;
}

TEST(TriangleTransformation, LimitsAreEquilateralAndGrowAsTheorem22Says) {
  for_random_triangles([](const Polygon& triangle, double theta) {
    const double growth = equilateral_growth(theta);
    EXPECT_EQ(growth > 1.0, theta > pi / 6.0);
    const Polygon limit = limit_of(triangle, theta, growth, equilateral_step);
    const auto [alpha, beta, gamma] = angles_of(limit);
    for (const double angle : {alpha, beta, gamma}) EXPECT_NEAR(angle, pi / 3.0, 1e-9);
    EXPECT_NEAR(sides_of(equilateral_step(limit, theta)).x, growth * sides_of(limit).x,
                1e-9 * growth);
  });
}

TEST(TriangleTransformation, LimitsAreRightAndIsoscelesAndGrowAsTheorem28Says) {
  for_random_triangles([](const Polygon& triangle, double theta) {
    const double growth = right_isosceles_growth(theta);
    EXPECT_EQ(growth > 1.0, theta > pi / 4.0);
    const Polygon limit = limit_of(triangle, theta, growth, right_isosceles_step);
    const auto [alpha, beta, gamma] = angles_of(limit);
    EXPECT_NEAR(alpha, pi / 2.0, 1e-9);
    EXPECT_NEAR(beta, pi / 4.0, 1e-9);
    EXPECT_NEAR(gamma, pi / 4.0, 1e-9);
    EXPECT_NEAR(sides_of(right_isosceles_step(limit, theta)).y, growth * sides_of(limit).y,
                1e-9 * growth);
  });
}

TEST(TriangleTransformation, KeepsTheOrientationAndOnlyTheEquilateralOneTheCentroid) {
  double moved = 0.0;
  for_random_triangles([&](const Polygon& start, double theta) {
    Polygon a = start, b = start;
    for (int i = 0; i < 20; ++i) {
      const Complex before = centroid(a);
      a = equilateral_step(a, theta);
      EXPECT_LT(std::abs(centroid(a) - before), 1e-13 * (1.0 + radius(a)));
      EXPECT_GT(signed_area(a), 0.0) << theta;
      a = scaled_about_centroid(a, 1.0 / radius(a));
      const Polygon next = right_isosceles_step(b, theta);
      EXPECT_GT(signed_area(next), 0.0) << theta;
      moved = std::max(moved, std::abs(centroid(next) - centroid(b)));
      b = scaled_about_centroid(next, 1.0 / radius(next));
    }
  });
  EXPECT_GT(moved, 0.1);
}

TEST(TriangleTransformation, SidesNeverBecomeZero) {
  // Two coinciding nodes, and three nodes on a line.
  for (const Polygon& start : {Polygon{{0, 0}, {1, 0}, {1, 0}}, Polygon{{0, 0}, {1, 0}, {0, 0}},
                               Polygon{{0, 0}, {1, 0}, {2, 0}}, Polygon{{0, 0}, {0, 0}, {1, 1}}})
    for (const double theta : {0.05, pi / 6.0, 0.9, 1.5}) {
      for (const auto& next :
           {equilateral_step(start, theta), right_isosceles_step(start, theta)}) {
        const auto [x, y, z] = sides_of(next);
        EXPECT_GT(std::min({x, y, z}), 1e-3);
      }
    }
}

}  // namespace
}  // namespace smoothfem
