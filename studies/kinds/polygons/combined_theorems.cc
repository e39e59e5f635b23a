// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/polygons/limit_polygons.h"
#include "studies/kinds/polygons/theorem_check.h"

namespace smoothfem {

namespace {

enum Stream : std::uint64_t { eigen = 300, domain, line, clockwise };

struct Parameters {
  double theta, lambda;
};

/// Draws again until lambda, a function of theta, is in (0, 1) and iteration does not take too
/// long.
template <class LambdaOf>
Parameters parameters_of(std::size_t n, SplitMix64& random, const LambdaOf& lambda_of) {
  constexpr double slowest = 0.99;
  for (;;) {
    const double theta = uniform(random, 0.0, 0.5 * pi), lambda = lambda_of(theta);
    if (lambda > 0.0 && lambda < 1.0 && classify(lambda, theta, n).convergence < slowest)
      return {theta, lambda};
  }
}

/// Draws parameters of the domain D_k: between its two lines, or between one line and the border.
Parameters parameters_of_domain(std::size_t n, std::size_t k, SplitMix64& random) {
  return parameters_of(n, random, [&](double theta) {
    const double from = k == n / 2 ? 0.0 : std::max(0.0, intersection_line(n, 2 * k + 1, theta));
    const double to = k == 0 ? 1.0 : std::min(1.0, intersection_line(n, 2 * k - 1, theta));
    return from < to ? uniform(random, from, to) : -1.0;
  });
}

Parameters parameters_of_line(std::size_t n, std::size_t k, SplitMix64& random) {
  return parameters_of(n, random,
                       [&](double theta) { return intersection_line(n, 2 * k + 1, theta); });
}

void check_eigenvalues(const PolygonStudy& study, std::vector<TheoremRow>& rows) {
  TheoremCheck values("Lemma 2.11", "eigenpolygon k is multiplied by its eigenvalue, no rotation",
                      "a step's difference from that / largest eigenvalue", 1e-12);
  TheoremCheck centroids("Section 2.3.1", "the centroid stays", "its way in a step", 1e-12);
  TheoremCheck roots("Lemma 2.12", "eigenvalue k > n/2 vanishes at lambda 1/2, pi (2k - n) / (2n)",
                     "the eigenvalue there", 1e-12);
  TheoremCheck positive("Lemma 2.12", "eigenvalues 0 to n/2 are positive", "the least of them",
                        0.0);
  TheoremCheck lines("Lemma 2.13", "eigenvalues k and m are equal on the line of (k + m) mod n",
                     "their difference / largest eigenvalue", 1e-12);
  for_polygons(study, Stream::eigen, [&](std::size_t n, SplitMix64& random) {
    const double lambda = uniform(random, 0.01, 0.99), theta = uniform(random, 0.01, 0.49 * pi);
    const auto eigen = eigenvalues(lambda, theta, n);
    const double largest = *std::max_element(eigen.begin(), eigen.end());
    const Polygon z = random_polygon(n, random);
    centroids.equal(std::abs(centroid(transformed(z, lambda, theta)) - centroid(z)) / largest, 0.0);
    for (std::size_t k = 0; k < n; ++k) {
      const Polygon v = eigenpolygon(n, k, 1.0);
      Polygon expected = v;
      for (Complex& node : expected) node *= eigen[k];
      values.equal(distance(transformed(v, lambda, theta), expected) / largest, 0.0);
      if (2 * k <= n) {
        positive.above(eigen[k], 0.0);
      } else {
        const double root = pi * (2.0 * as_double(k) - as_double(n)) / (2.0 * as_double(n));
        roots.equal(eigenvalues(0.5, root, n)[k], 0.0);
      }
    }
    for (std::size_t sum = 1; sum < n; ++sum) {
      const double on_line = intersection_line(n, sum, theta);
      if (!(on_line > 0.0 && on_line < 1.0)) continue;
      const auto there = eigenvalues(on_line, theta, n);
      for (std::size_t k = 0; k < n; ++k)
        lines.equal(
            (there[k] - there[(n + sum - k) % n]) / *std::max_element(there.begin(), there.end()),
            0.0);
    }
  });
  for (const auto& check : {values, centroids, roots, positive, lines}) rows.push_back(check.row());
}

void check_limits(const PolygonStudy& study, std::vector<TheoremRow>& rows) {
  TheoremCheck dominant("Lemma 2.14", "in D_k eigenvalue k is larger than all others",
                        "(it - the next) / it", 0.0);
  TheoremCheck pair("Lemma 2.14",
                    "on S_k eigenvalues k and k + 1 are equal and larger than the others",
                    "(they - the next) / they", 0.0);
  const std::string quantity = "distance from it after the last step";
  TheoremCheck domains("Theorem 2.13",
                       "in D_k scaled iterates tend to eigenpolygon k and the centroid", quantity,
                       1e-8);
  TheoremCheck lines("Theorem 2.13", "on S_k scaled iterates tend to eigenpolygons k and k + 1",
                     quantity, 1e-8);
  const auto run = [&](std::size_t n, Parameters p, std::vector<std::size_t> expected,
                       SplitMix64& random, TheoremCheck& largest, TheoremCheck& limits) {
    auto values = eigenvalues(p.lambda, p.theta, n);
    const double growth = values[expected.front()];
    for (const std::size_t k : expected) values[k] = 0.0;
    largest.above((growth - *std::max_element(values.begin(), values.end())) / growth, 0.0);
    Polygon z = random_polygon(n, random);
    const Polygon limit = limit_polygon(z, {.dominant = expected});
    // About the initial centroid (2.35). An iterate's centroid has rounding errors, which would not
    // be scaled down again.
    const Complex middle = centroid(z);
    for (std::size_t i = 0; i < study.steps; ++i)
      z = scaled_about(middle, transformed(z, p.lambda, p.theta), 1.0 / growth);
    limits.equal(distance(z, limit), 0.0);
  };
  for_polygons(study, Stream::domain, [&](std::size_t n, SplitMix64& random) {
    for (std::size_t k = 0; k <= n / 2; ++k)
      run(n, parameters_of_domain(n, k, random), {k}, random, dominant, domains);
  });
  for_polygons(study, Stream::line, [&](std::size_t n, SplitMix64& random) {
    for (std::size_t k = 0; k < n / 2; ++k)
      run(n, parameters_of_line(n, k, random), {k, k + 1}, random, pair, lines);
  });
  for (const auto& check : {dominant, pair, domains, lines}) rows.push_back(check.row());
}

void check_clockwise(const PolygonStudy& study, std::vector<TheoremRow>& rows) {
  TheoremCheck check("Section 2.3.3", "a clockwise regular polygon vanishes in one step",
                     "size after a step at lambda 1/2, pi (n - 2) / (2n), size 1 before", 1e-12);
  for_polygons(study, Stream::clockwise, [&](std::size_t n, SplitMix64& random) {
    Polygon z = eigenpolygon(n, n - 1, std::polar(1.0, uniform(random, 0.0, 2.0 * pi)));
    const Complex shift = random_polygon(1, random).front();
    for (Complex& node : z) node += shift;
    check.equal(radius(transformed(z, 0.5, pi * (as_double(n) - 2.0) / (2.0 * as_double(n)))), 0.0);
  });
  rows.push_back(check.row());
}

}  // namespace

std::vector<TheoremRow> combined_theorems(const PolygonStudy& study) {
  std::vector<TheoremRow> rows;
  check_eigenvalues(study, rows);
  check_limits(study, rows);
  check_clockwise(study, rows);
  return rows;
}

}  // namespace smoothfem
