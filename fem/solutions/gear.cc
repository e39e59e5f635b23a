// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "fem/solutions/manufactured_solution.h"

namespace smoothfem {

namespace {

/// amplitude sin((x + 1)(y - 1) / 2) + offset: with phi = (x + 1)(y - 1) / 2, |grad phi|^2 =
/// ((x + 1)^2 + (y - 1)^2) / 4 and laplace(phi) = 0.
ManufacturedSolution<2> gear_solution() {
  constexpr double amplitude = 40.0, offset = 60.0;
  const auto phase = [](const Point<2>& p) { return 0.5 * (p.x() + 1.0) * (p.y() - 1.0); };
  const auto phase_gradient = [](const Point<2>& p) {
    return Point<2>(0.5 * (p.y() - 1.0), 0.5 * (p.x() + 1.0));
  };
  return {.name = "gear",
          .formula = "40 sin((x + 1)(y - 1) / 2) + 60",
          .source = "Section 6.2",
          .value = [=](const Point<2>& p) { return amplitude * std::sin(phase(p)) + offset; },
          .value_and_gradient = [=](const Point<2>& p) -> ValueAndGradient<2> {
            return {amplitude * std::sin(phase(p)) + offset,
                    amplitude * std::cos(phase(p)) * phase_gradient(p)};
          },
          .load =
              [=](const Point<2>& p) {
                return amplitude * std::sin(phase(p)) * phase_gradient(p).squaredNorm();
              }};
}

const RegisteredSolution<2> registered(gear_solution());

}  // namespace

}  // namespace smoothfem
