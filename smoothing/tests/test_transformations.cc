// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <complex>
#include <numeric>

#include "smoothing/getme/regularize.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/tests/planar_meshes.h"

namespace smoothfem {
namespace {

using Complex = std::complex<double>;
using Polygon = std::vector<Complex>;
constexpr double lambda = 0.35, theta = std::numbers::pi / 12.0;

std::vector<Vector2<double>> vectors(const Polygon& polygon) {
  std::vector<Vector2<double>> result;
  for (const auto& z : polygon) result.push_back({z.real(), z.imag()});
  return result;
}

Polygon apply(const Polygon& polygon, double l = lambda, double t = theta) {
  const auto in = vectors(polygon);
  std::vector<Vector2<double>> out(in.size());
  PolygonTransformation(l, t).apply(std::span<const Vector2<double>>(in),
                                    std::span<Vector2<double>>(out));
  Polygon result;
  for (const auto& p : out) result.emplace_back(p.x, p.y);
  return result;
}

Polygon random_polygon(std::size_t n) {
  test::Random random(n);
  Polygon polygon;
  for (std::size_t k = 0; k < n; ++k) {
    const double x = random(), y = random();
    polygon.emplace_back(x, y);
  }
  return polygon;
}

Complex root(std::size_t n, std::size_t k) {
  return std::polar(1.0, 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n));
}

double distance(const Polygon& a, const Polygon& b) {
  double longest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) longest = std::max(longest, std::abs(a[k] - b[k]));
  return longest;
}

/// Takes the apices of similar triangles on the sides, and once more with reversed orientation.
Polygon two_half_steps(const Polygon& z) {
  const std::size_t n = z.size();
  const Complex w(lambda, (1.0 - lambda) * std::tan(theta));
  Polygon half(n), full(n);
  for (std::size_t k = 0; k < n; ++k) half[(k + 1) % n] = w * z[k] + (1.0 - w) * z[(k + 1) % n];
  for (std::size_t k = 0; k < n; ++k)
    full[k] = (1.0 - std::conj(w)) * half[k] + std::conj(w) * half[(k + 1) % n];
  return full;
}

TEST(PolygonTransformation, IsTwoHalfStepsWithSimilarTriangles) {
  for (std::size_t n = 3; n <= 9; ++n) {
    const auto z = random_polygon(n);
    EXPECT_LT(distance(apply(z), two_half_steps(z)), 1e-14) << n;
  }
}

TEST(PolygonTransformation, KeepsTheCentroid) {
  for (std::size_t n = 3; n <= 9; ++n) {
    const auto z = random_polygon(n), t = apply(z);
    const auto sum = [](const Polygon& p) {
      return std::accumulate(p.begin(), p.end(), Complex());
    };
    EXPECT_LT(std::abs(sum(t) - sum(z)), 1e-13) << n;
  }
}

TEST(PolygonTransformation, CommutesWithSimilarities) {
  for (std::size_t n = 3; n <= 9; ++n) {
    const auto z = random_polygon(n);
    const auto similar = [](Polygon p) {
      for (auto& w : p) w = Complex(3.0, -2.0) + std::polar(5.0, 0.7) * w;
      return p;
    };
    EXPECT_LT(distance(apply(similar(z)), similar(apply(z))), 1e-13) << n;
  }
}

TEST(PolygonTransformation, HasTheKnownEigenvalues) {
  const Complex w(lambda, (1.0 - lambda) * std::tan(theta));
  for (std::size_t n = 3; n <= 7; ++n)
    for (std::size_t k = 0; k < n; ++k) {
      Polygon eigenpolygon, expected;
      const double eigenvalue = std::norm(1.0 - w + root(n, k) * w);
      for (std::size_t j = 0; j < n; ++j) {
        eigenpolygon.push_back(std::conj(root(n, j * k)));
        expected.push_back(eigenvalue * eigenpolygon.back());
      }
      EXPECT_LT(distance(apply(eigenpolygon), expected), 1e-13) << n << ' ' << k;
    }
}

TEST(PolygonTransformation, TwiceNapoleonMakesTrianglesRegularAtOnce) {
  const auto t = vectors(apply(random_polygon(3), 0.5, std::numbers::pi / 6.0));
  EXPECT_NEAR(std::abs(mean_ratio(std::span<const Vector2<double>>(t))), 1.0, 1e-12);
}

std::vector<Vector2<double>> regularized(const std::vector<Vector2<double>>& in, double rho) {
  std::vector<Vector2<double>> out(in.size());
  const ElementRegularization<2> element(
      {.lambda = lambda, .theta_degrees = theta * 180.0 / std::numbers::pi, .rho = rho});
  element.regularize(std::span<const Vector2<double>>(in), std::span<Vector2<double>>(out));
  return out;
}

TEST(Regularize, MakesPolygonsRegular) {
  for (std::size_t n = 3; n <= 8; ++n) {
    auto polygon = vectors(random_polygon(n));
    for (int i = 0; i < 3000; ++i) polygon = regularized(polygon, 1.0);
    EXPECT_NEAR(mean_ratio(std::span<const Vector2<double>>(polygon)), 1.0, 1e-9) << n;
  }
}

TEST(Regularize, KeepsRegularPolygons) {
  for (std::size_t n = 3; n <= 8; ++n) {
    Polygon regular;
    for (std::size_t k = 0; k < n; ++k) regular.push_back(Complex(4.0, 5.0) + 2.0 * root(n, k));
    const auto in = vectors(regular), out = regularized(in, 1.0);
    for (std::size_t k = 0; k < n; ++k) EXPECT_LT(length(out[k] - in[k]), 1e-13) << n;
  }
}

TEST(Regularize, KeepsThePerimeterAndRelaxesTowardsTheResult) {
  for (std::size_t n = 3; n <= 8; ++n) {
    const auto in = vectors(random_polygon(n)), full = regularized(in, 1.0),
               tenth = regularized(in, 0.1);
    const auto sides = [](const auto& p) { return perimeter(std::span<const Vector2<double>>(p)); };
    EXPECT_NEAR(sides(full), sides(in), 1e-13 * sides(in)) << n;
    for (std::size_t k = 0; k < n; ++k)
      EXPECT_LT(length(10.0 * (tenth[k] - in[k]) - (full[k] - in[k])), 1e-12) << n;
  }
}

}  // namespace
}  // namespace smoothfem
