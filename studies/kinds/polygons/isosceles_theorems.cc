// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/polygons/isosceles_transformation.h"
#include "studies/kinds/polygons/theorem_check.h"

namespace smoothfem {

namespace {

enum Stream : std::uint64_t { eigen = 200, between, on_angles, shapes, regular };

/// Returns the base angle at which limits change from kind k to k + 1 (Lemma 2.10).
double characteristic_angle(std::size_t n, std::size_t k) {
  return pi * (2.0 * as_double(k) + 1.0) / (2.0 * as_double(n));
}

/// Draws an angle between the characteristic angles k - 1 and k, at least a quarter of the interval
/// away from them.
double angle_of_domain(std::size_t n, std::size_t k, SplitMix64& random) {
  const double from = k == 0 ? 0.0 : characteristic_angle(n, k - 1);
  const double to = k == n / 2 ? 0.5 * pi : characteristic_angle(n, k);
  return from + uniform(random, 0.25, 0.75) * (to - from);
}

void check_eigenvalues(const PolygonStudy& study, std::vector<TheoremRow>& rows) {
  TheoremCheck values("Lemma 2.7", "eigenpolygon k is multiplied by its eigenvalue",
                      "a step's difference from that / eigenvalue of greatest modulus", 1e-12);
  TheoremCheck decomposition("Equation (2.16)", "a polygon is the sum of its eigenpolygons",
                             "distance of the sum from the polygon", 1e-12);
  TheoremCheck dominant("Lemma 2.10", "between characteristic angles one eigenvalue dominates",
                        "its modulus - greatest other modulus", 0.0);
  TheoremCheck pairs("Lemma 2.10", "at these angles eigenvalues k and k + 1 have equal moduli",
                     "quotient of the moduli", 1e-12);
  for_polygons(study, Stream::eigen, [&](std::size_t n, SplitMix64& random) {
    const Polygon z = random_polygon(n, random);
    const auto coefficients = eigenpolygon_coefficients(z);
    decomposition.equal(distance(sum_of_eigenpolygons(coefficients), z), 0.0);
    for (std::size_t k = 0; k <= n / 2; ++k) {
      const double theta = angle_of_domain(n, k, random);
      const auto eigen = isosceles_eigenvalues(theta, n);
      double others = 0.0;
      for (std::size_t m = 0; m < n; ++m) {
        if (m != k) others = std::max(others, std::abs(eigen[m]));
        const Polygon v = eigenpolygon(n, m, coefficients[m]);
        Polygon expected = v;
        for (Complex& node : expected) node *= eigen[m];
        values.equal(distance(isosceles_step(v, theta), expected) / std::abs(eigen[k]), 0.0);
      }
      dominant.above(std::abs(eigen[k]) - others, 0.0);
      if (k == n / 2) continue;
      const auto equal = isosceles_eigenvalues(characteristic_angle(n, k), n);
      pairs.equal(std::abs(equal[k]) / std::abs(equal[k + 1]), 1.0);
    }
  });
  for (const auto& check : {values, decomposition, dominant, pairs}) rows.push_back(check.row());
}

/// Returns the iterate after n_steps scaled steps.
Polygon iterated(std::size_t n_steps, Polygon z, double theta, double growth) {
  const Complex middle = centroid(z);
  for (std::size_t i = 0; i < n_steps; ++i)
    z = scaled_about(middle, isosceles_step(z, theta), 1.0 / growth);
  return z;
}

void check_limits(const PolygonStudy& study, std::vector<TheoremRow>& rows) {
  TheoremCheck domains("Theorem 2.10",
                       "between the angles scaled iterates tend to a turning eigenpolygon k",
                       "distance from it after the last step", 1e-8);
  TheoremCheck angles("Theorem 2.10",
                      "at the angles they tend to the sum of eigenpolygons k and k + 1",
                      "distance from it after the last step", 1e-8);
  TheoremCheck shift("Theorem 2.12",
                     "two steps later the limit's nodes are those one number further",
                     "distance of an iterate from that", 1e-8);
  TheoremCheck growth("Corollary 2.3",
                      "polygons shrink, stay bounded or grow by the dominant modulus",
                      "growth of the size in the last step / modulus", 1e-8);
  const auto run = [&](std::size_t n, std::size_t k, double theta, SplitMix64& random,
                       TheoremCheck& check) {
    const Polygon start = random_polygon(n, random);
    const double modulus = classify_isosceles(theta, n).growth;
    const Polygon z = iterated(study.steps, start, theta, modulus);
    check.equal(distance(z, isosceles_limit(start, theta, study.steps)), 0.0);
    const Polygon later = iterated(2, z, theta, modulus);
    Polygon shifted(n);
    for (std::size_t m = 0; m < n; ++m) shifted[m] = z[(m + 1) % n];
    shift.equal(distance(later, shifted), 0.0);
    if (k > 0) growth.equal(radius(isosceles_step(later, theta)) / radius(later) / modulus, 1.0);
  };
  for_polygons(study, Stream::between, [&](std::size_t n, SplitMix64& random) {
    for (std::size_t k = 0; k <= n / 2; ++k)
      run(n, k, angle_of_domain(n, k, random), random, domains);
  });
  TheoremCheck collapse("Corollary 2.3",
                        "for theta < pi/(2n) polygons degenerate to their centroid",
                        "size after the last step / size before the first", 1e-8);
  for_polygons(study, Stream::on_angles, [&](std::size_t n, SplitMix64& random) {
    // Growth does not settle at the angles: two eigenpolygons turn against one another.
    for (std::size_t k = 0; k < n / 2; ++k) run(n, 0, characteristic_angle(n, k), random, angles);
    const Polygon start = random_polygon(n, random);
    collapse.equal(
        radius(iterated(study.steps, start, angle_of_domain(n, 0, random), 1.0)) / radius(start),
        0.0);
  });
  for (const auto& check : {domains, angles, shift, growth, collapse}) rows.push_back(check.row());
}

/// Counts nodes that coincide with node m, including m.
std::size_t multiplicity(const Polygon& polygon, std::size_t m) {
  const double same = 1e-9 * radius(polygon);
  return static_cast<std::size_t>(
      std::count_if(polygon.begin(), polygon.end(),
                    [&](const Complex& z) { return std::abs(z - polygon[m]) < same; }));
}

/// True if all corners turn left, and the polygon turns once around.
bool is_convex(const Polygon& polygon, std::size_t vertices) {
  double turning = 0.0;
  for (std::size_t m = 0; m < vertices; ++m) {
    const std::size_t n = polygon.size();
    const double corner = std::arg((polygon[(m + 2) % n] - polygon[(m + 1) % n]) /
                                   (polygon[(m + 1) % n] - polygon[m]));
    if (!(corner > 0.0)) return false;
    turning += corner;
  }
  return vertices > 2 && std::abs(turning - 2.0 * pi) < 1e-6;
}

void check_shapes(const PolygonStudy& study, std::vector<TheoremRow>& rows) {
  TheoremCheck vertices("Theorem 2.11", "eigenpolygon k has n / gcd(n, k) vertices",
                        "distinct nodes - n / gcd(n, k)", 0.0);
  TheoremCheck multiple("Theorem 2.11", "gcd(n, k) nodes are at each vertex",
                        "nodes at a vertex - gcd(n, k)", 0.0);
  TheoremCheck convex("Theorem 2.11", "it is convex if and only if k divides n",
                      "1 if convex - 1 if k divides n (segments: 0)", 0.0);
  for_polygons(study, Stream::shapes, [&](std::size_t n, SplitMix64& random) {
    const auto coefficients = eigenpolygon_coefficients(random_polygon(n, random));
    for (std::size_t k = 1; k <= n / 2; ++k) {
      const Polygon v = eigenpolygon(n, k, coefficients[k]);
      const StarPolygon star = star_polygon(n, k);
      double distinct = 0.0;
      for (std::size_t m = 0; m < n; ++m) {
        const double here = as_double(multiplicity(v, m));
        distinct += 1.0 / here;
        multiple.equal(here - as_double(star.multiplicity), 0.0);
      }
      vertices.equal(std::round(distinct) - as_double(star.vertices), 0.0);
      convex.equal(
          as_double(is_convex(v, star.vertices)) - as_double(n % k == 0 && star.vertices > 2), 0.0);
    }
  });
  for (const auto& check : {vertices, multiple, convex}) rows.push_back(check.row());
}

void check_petr_douglas_neumann(const PolygonStudy& study, std::vector<TheoremRow>& rows) {
  TheoremCheck check("Petr-Douglas-Neumann",
                     "n - 2 steps with chosen angles leave a regular polygon",
                     "distance of node m + 1 from node m turned by 2 pi k / n, size 1", 1e-8);
  for_polygons(study, Stream::regular, [&](std::size_t n, SplitMix64& random) {
    for (std::size_t k = 1; k < n; ++k) {
      Polygon z = petr_douglas_neumann_polygon(random_polygon(n, random), k);
      const Complex middle = centroid(z);
      for (Complex& node : z) node -= middle;
      Polygon turned(n);
      for (std::size_t m = 0; m < n; ++m)
        turned[(m + 1) % n] = z[m] * std::polar(1.0, 2.0 * pi * as_double(k) / as_double(n));
      check.equal(distance(z, turned) / radius(z), 0.0);
    }
  });
  rows.push_back(check.row());
}

}  // namespace

std::vector<TheoremRow> isosceles_theorems(const PolygonStudy& study) {
  std::vector<TheoremRow> rows;
  check_eigenvalues(study, rows);
  check_limits(study, rows);
  check_shapes(study, rows);
  check_petr_douglas_neumann(study, rows);
  return rows;
}

}  // namespace smoothfem
