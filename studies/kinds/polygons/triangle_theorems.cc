// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/polygons/isosceles_transformation.h"
#include "smoothing/polygons/triangle_transformations.h"
#include "studies/kinds/polygons/theorem_check.h"

namespace smoothfem {

namespace {

enum Stream : std::uint64_t {
  sides = 100,
  steps,
  degenerate,
  limits,
  below_30,
  up_to_45,
  napoleon
};

double squared(double value) {
  return value * value;
}

double random_angle(SplitMix64& random) {
  return uniform(random, 0.02, 0.5 * pi - 0.02);
}

/// Returns a counterclockwise triangle.
Polygon random_triangle(SplitMix64& random) {
  Polygon triangle = random_polygon(3, random);
  if (signed_area(triangle) < 0.0) std::swap(triangle[1], triangle[2]);
  return triangle;
}

Polygon unit_sized(const Polygon& triangle) {
  return scaled_about_centroid(triangle, 1.0 / radius(triangle));
}

/// Returns 1 - shorter / longer.
double defect(double a, double b) {
  return 1.0 - std::min(a, b) / std::max(a, b);
}

double min_side(const Polygon& triangle) {
  const auto [x, y, z] = sides_of(triangle);
  return std::min({x, y, z});
}

using Step = Polygon (*)(const Polygon&, double);
using Angles = double (*)(double);

void check_side_lengths(const PolygonStudy& study, std::vector<TheoremRow>& rows) {
  TheoremCheck equilateral("Lemma 2.1", "sides after a step follow from sides and area before it",
                           "x^2 in units of the longest squared side", 1e-12);
  TheoremCheck right("Lemma 2.5", "the same for the right isosceles case", "y^2, same units",
                     1e-12);
  TheoremCheck difference("Equation (2.8)", "x^2 - y^2 - z^2 is multiplied by (1 - t^2) / 4",
                          "x^2 - y^2 - z^2, same units", 1e-12);
  for_cases(study, Stream::sides, [&](SplitMix64& random) {
    const Polygon triangle = random_triangle(random);
    const double t = std::tan(random_angle(random)), area = signed_area(triangle);
    const auto [x, y, z] = sides_of(triangle);
    const double unit = squared(std::max({x, y, z})) * (1.0 + t * t);
    const double x2 = 0.5 * t * t * (y * y + z * z) + 0.25 * (1.0 - t * t) * x * x + 2.0 * t * area;
    equilateral.equal(squared(sides_of(equilateral_step(triangle, std::atan(t))).x) / unit,
                      x2 / unit);
    const TriangleSides next = sides_of(right_isosceles_step(triangle, std::atan(t)));
    right.equal(squared(next.y) / unit, (0.25 * (y * y + t * t * z * z) + t * area) / unit);
    difference.equal((squared(next.x) - squared(next.y) - squared(next.z)) / unit,
                     0.25 * (1.0 - t * t) * (x * x - y * y - z * z) / unit);
  });
  for (const auto& check : {equilateral, right, difference}) rows.push_back(check.row());
}

void check_no_side_vanishes(const PolygonStudy& study, Step step, const std::string& theorem,
                            std::vector<TheoremRow>& rows) {
  TheoremCheck check(theorem,
                     "no side is zero after a step, though nodes may be on a line or equal",
                     "shortest side after one step, nodes of size 1", 0.0);
  for_cases(study, Stream::degenerate, [&](SplitMix64& random) {
    const Polygon ends = random_polygon(2, random);
    const double theta = random_angle(random), where = random.uniform();
    for (const Complex third : {ends[0] + where * (ends[1] - ends[0]), ends[0], ends[1]})
      check.above(min_side(step(unit_sized({ends[0], ends[1], third}), theta)), 0.0);
  });
  rows.push_back(check.row());
}

/// Compares defects of at least 1e-6, because rounding decides smaller ones.
void shrinks(TheoremCheck& check, double before, double after, double factor) {
  constexpr double least = 1e-6;
  if (factor * before >= least) check.at_most(after / (factor * before), 1.0);
}

/// Checks a statement on two steps. defect_of(triangle): the number that shrinks.
template <class Defect>
void check_two_steps(const PolygonStudy& study, Step step, Angles factor, TheoremCheck check,
                     const Defect& defect_of, std::vector<TheoremRow>& rows) {
  constexpr int n_pairs = 10;
  for_cases(study, Stream::steps, [&](SplitMix64& random) {
    const double theta = random_angle(random);
    Polygon triangle = random_triangle(random);
    for (int i = 0; i < n_pairs; ++i) {
      const Polygon next = unit_sized(step(step(triangle, theta), theta));
      shrinks(check, defect_of(triangle), defect_of(next), factor(theta));
      triangle = next;
    }
  });
  rows.push_back(check.row());
}

void check_convergence(const PolygonStudy& study, std::vector<TheoremRow>& rows) {
  const std::string quantity = "defect after two steps / (factor * defect before)";
  check_two_steps(
      study, equilateral_step, equilateral_convergence_factor,
      {"Proposition 2.1", "in two steps 1 - y/x shrinks by (1 - 3 t^2)^2 / (1 + 9 t^4) at least",
       quantity, 1e-9},
      [](const Polygon& p) { return defect(sides_of(p).x, sides_of(p).y); }, rows);
  check_two_steps(
      study, right_isosceles_step, right_isosceles_convergence_factor,
      {"Proposition 2.3", "in two steps 1 - z/y shrinks by (1 - t^2)^2 / (1 + t^4) at least",
       quantity, 1e-9},
      [](const Polygon& p) { return defect(sides_of(p).y, sides_of(p).z); }, rows);
  check_two_steps(
      study, right_isosceles_step, right_isosceles_convergence_factor,
      {"Proposition 2.4", "the same for |1 - (y^2 + z^2) / x^2|", quantity, 1e-9},
      [](const Polygon& p) {
        const auto [x, y, z] = sides_of(p);
        return std::abs(1.0 - (y * y + z * z) / (x * x));
      },
      rows);
}

/// Checks Proposition 2.2. Its factors are those of its proof. For theta > pi/6 the factor also
/// depends on the triangle.
void check_one_step(const PolygonStudy& study, std::vector<TheoremRow>& rows) {
  constexpr int n_steps = 20;
  const std::string quantity = "defect after a step / (factor * defect before)";
  TheoremCheck small("Proposition 2.2", "theta < pi/6: 1 - y/x shrinks by 1 - 3 t^2 in each step",
                     quantity, 1e-9);
  TheoremCheck large("Proposition 2.2",
                     "pi/6 < theta <= pi/4: the same, with a factor that depends on z/x, too",
                     quantity, 1e-9);
  const auto run = [&](SplitMix64& random, double theta, TheoremCheck& check) {
    Polygon triangle = random_triangle(random);
    const auto ratio = [](const Polygon& p) {
      return sides_of(p).z / std::max(sides_of(p).x, sides_of(p).y);
    };
    const double least = std::min({1.0, ratio(triangle), ratio(equilateral_step(triangle, theta))});
    const double factor =
        theta < pi / 6.0 ? 1.0 - 3.0 * squared(std::tan(theta)) : 1.0 / (1.0 + least * least);
    for (int i = 0; i < n_steps; ++i) {
      const Polygon next = unit_sized(equilateral_step(triangle, theta));
      shrinks(check, defect(sides_of(triangle).x, sides_of(triangle).y),
              defect(sides_of(next).x, sides_of(next).y), factor);
      triangle = next;
    }
  };
  for_cases(study, Stream::below_30,
            [&](SplitMix64& random) { run(random, uniform(random, 0.01, pi / 6.0), small); });
  for_cases(study, Stream::up_to_45,
            [&](SplitMix64& random) { run(random, uniform(random, pi / 6.0, pi / 4.0), large); });
  rows.push_back(small.row());
  rows.push_back(large.row());
}

struct LimitCase {
  std::string growth_theorem, growth, angles_theorem, angles, orientation_theorem;
  Step step;
  Angles growth_of;
  double steady_theta;  ///< theta for which sizes do not change
  TriangleAngles limit;
};

void check_limit(const PolygonStudy& study, const LimitCase& c, std::vector<TheoremRow>& rows) {
  TheoremCheck growth(c.growth_theorem, "sides grow by " + c.growth + " a step in the long run",
                      "growth of x in the last step / growth expected", 1e-10);
  TheoremCheck steady(c.growth_theorem, "for growth 1 sizes stay from the first step on",
                      "x after 20 steps / x after one", 1e-12);
  TheoremCheck angles(c.angles_theorem, "triangles tend to " + c.angles, "an angle in the limit",
                      1e-7);
  TheoremCheck orientation(c.orientation_theorem, "triangles stay counterclockwise",
                           "signed area, nodes of size 1", 0.0);
  for_cases(study, Stream::limits, [&](SplitMix64& random) {
    const Polygon start = random_triangle(random);
    const double theta = random_angle(random);
    Polygon triangle = start;
    for (std::size_t i = 0; i < study.steps; ++i) {
      triangle = unit_sized(c.step(triangle, theta));
      orientation.above(signed_area(triangle), 0.0);
    }
    const auto [alpha, beta, gamma] = angles_of(triangle);
    angles.equal(alpha, c.limit.alpha);
    angles.equal(beta, c.limit.beta);
    angles.equal(gamma, c.limit.gamma);
    growth.equal(sides_of(c.step(triangle, theta)).x / sides_of(triangle).x / c.growth_of(theta),
                 1.0);
    const double x = sides_of(c.step(start, c.steady_theta)).x;
    triangle = start;
    for (int i = 0; i < 20; ++i) triangle = c.step(triangle, c.steady_theta);
    steady.equal(sides_of(triangle).x / x, 1.0);
  });
  for (const auto& check : {growth, steady, angles, orientation}) rows.push_back(check.row());
}

void check_centroid_and_napoleon(const PolygonStudy& study, std::vector<TheoremRow>& rows) {
  TheoremCheck centroids("Theorem 2.4", "the centroid stays", "its way in ten steps / final size",
                         1e-13);
  TheoremCheck equal_sides("Napoleon",
                           "centroids of equilateral triangles on the sides are equilateral",
                           "a side / side from the triangle's sides and area", 1e-10);
  for_cases(study, Stream::napoleon, [&](SplitMix64& random) {
    const Polygon start = random_triangle(random);
    const double theta = random_angle(random);
    Polygon triangle = start;
    for (int i = 0; i < 10; ++i) triangle = equilateral_step(triangle, theta);
    centroids.equal(
        std::abs(centroid(triangle) - centroid(start)) / std::max(radius(triangle), radius(start)),
        0.0);
    const auto [x, y, z] = sides_of(start);
    const double side =
        std::sqrt((x * x + y * y + z * z) / 6.0 + 2.0 / std::sqrt(3.0) * signed_area(start));
    const TriangleSides found = sides_of(napoleon_triangle(start));
    for (const double length : {found.x, found.y, found.z}) equal_sides.equal(length / side, 1.0);
  });
  rows.push_back(centroids.row());
  rows.push_back(equal_sides.row());
}

}  // namespace

std::vector<TheoremRow> triangle_theorems(const PolygonStudy& study) {
  std::vector<TheoremRow> rows;
  check_side_lengths(study, rows);
  check_no_side_vanishes(study, equilateral_step, "Theorem 2.1", rows);
  check_no_side_vanishes(study, right_isosceles_step, "Theorem 2.6", rows);
  check_convergence(study, rows);
  check_one_step(study, rows);
  check_limit(study,
              {.growth_theorem = "Theorem 2.2",
               .growth = "(1 + sqrt(3) t) / 2",
               .angles_theorem = "Theorem 2.3",
               .angles = "equilateral ones",
               .orientation_theorem = "Theorem 2.5",
               .step = equilateral_step,
               .growth_of = equilateral_growth,
               .steady_theta = pi / 6.0,
               .limit = {pi / 3.0, pi / 3.0, pi / 3.0}},
              rows);
  check_limit(study,
              {.growth_theorem = "Theorem 2.8",
               .growth = "(1 + t) / 2",
               .angles_theorem = "Theorem 2.7",
               .angles = "right isosceles ones",
               .orientation_theorem = "Theorem 2.9",
               .step = right_isosceles_step,
               .growth_of = right_isosceles_growth,
               .steady_theta = pi / 4.0,
               .limit = {pi / 2.0, pi / 4.0, pi / 4.0}},
              rows);
  check_centroid_and_napoleon(study, rows);
  return rows;
}

}  // namespace smoothfem
