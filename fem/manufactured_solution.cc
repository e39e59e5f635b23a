#include "fem/manufactured_solution.h"

#include <cmath>
#include <numbers>

namespace smoothfem {

namespace {

/// amplitude sin((x + 1)(y - 1) / 2) + offset: with phi = (x + 1)(y - 1) / 2, |grad phi|^2 =
/// ((x + 1)^2 + (y - 1)^2) / 4 and laplace(phi) = 0.
ManufacturedSolution gear_solution() {
  constexpr double amplitude = 40.0, offset = 60.0;
  const auto phase = [](const Point<2>& p) { return 0.5 * (p.x() + 1.0) * (p.y() - 1.0); };
  const auto phase_gradient = [](const Point<2>& p) {
    return Point<2>(0.5 * (p.y() - 1.0), 0.5 * (p.x() + 1.0));
  };
  return {.name = "gear",
          .formula = "40 sin((x + 1)(y - 1) / 2) + 60",
          .source = "Section 6.2",
          .value = [=](const Point<2>& p) { return amplitude * std::sin(phase(p)) + offset; },
          .gradient = [=](const Point<2>& p) -> Point<2> {
            return amplitude * std::cos(phase(p)) * phase_gradient(p);
          },
          .load =
              [=](const Point<2>& p) {
                return amplitude * std::sin(phase(p)) * phase_gradient(p).squaredNorm();
              }};
}

ManufacturedSolution sine_solution() {
  constexpr double pi = std::numbers::pi;
  return {.name = "sine",
          .formula = "sin(pi x) sin(pi y)",
          .source = "the usual first test",
          .value = [](const Point<2>& p) { return std::sin(pi * p.x()) * std::sin(pi * p.y()); },
          .gradient =
              [](const Point<2>& p) {
                return Point<2>(pi * std::cos(pi * p.x()) * std::sin(pi * p.y()),
                                pi * std::sin(pi * p.x()) * std::cos(pi * p.y()));
              },
          .load =
              [](const Point<2>& p) {
                return 2.0 * pi * pi * std::sin(pi * p.x()) * std::sin(pi * p.y());
              }};
}

ManufacturedSolution linear_solution() {
  return {.name = "linear",
          .formula = "1 + 2 x - 3 y",
          .source = "lies in every space: errors are round-off",
          .value = [](const Point<2>& p) { return 1.0 + 2.0 * p.x() - 3.0 * p.y(); },
          .gradient = [](const Point<2>&) { return Point<2>(2.0, -3.0); },
          .load = [](const Point<2>&) { return 0.0; }};
}

ManufacturedSolution quadratic_solution() {
  return {.name = "quadratic",
          .formula = "x^2 + x y - 2 y^2 + y",
          .source = "lies in the spaces of degree 2: errors are round-off",
          .value =
              [](const Point<2>& p) {
                return p.x() * p.x() + p.x() * p.y() - 2.0 * p.y() * p.y() + p.y();
              },
          .gradient =
              [](const Point<2>& p) {
                return Point<2>(2.0 * p.x() + p.y(), p.x() - 4.0 * p.y() + 1.0);
              },
          .load = [](const Point<2>&) { return 2.0; }};
}

}  // namespace

const std::vector<ManufacturedSolution>& manufactured_solutions() {
  static const std::vector<ManufacturedSolution> all{gear_solution(), linear_solution(),
                                                     quadratic_solution(), sine_solution()};
  return all;
}

const ManufacturedSolution& manufactured_solution(const std::string& name) {
  std::vector<std::string> known;
  for (const auto& solution : manufactured_solutions()) {
    if (solution.name == name) return solution;
    known.push_back(solution.name);
  }
  throw InputError("there is no solution '" + name + "'; " + choose_one_of(known) +
                   ", or give an expression");
}

}  // namespace smoothfem
