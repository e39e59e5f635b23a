// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "fem/solutions/manufactured_solution.h"

namespace smoothfem {

namespace {

/// amplitude sin(a) cos(b) + offset with a = 2x + y, b = y - 3z: |grad a|^2 = 5, |grad b|^2 = 10,
/// grad a . grad b = 1.
ManufacturedSolution<3> volume_solution() {
  constexpr double amplitude = 35.0, offset = 60.0;
  const auto a = [](const Point<3>& p) { return 2.0 * p.x() + p.y(); };
  const auto b = [](const Point<3>& p) { return p.y() - 3.0 * p.z(); };
  return {
      .name = "volume",
      .formula = "35 sin(2x + y) cos(y - 3z) + 60",
      .source = "Section 6.3",
      .value =
          [=](const Point<3>& p) { return amplitude * std::sin(a(p)) * std::cos(b(p)) + offset; },
      .value_and_gradient = [=](const Point<3>& p) -> ValueAndGradient<3> {
        const double sin_a = std::sin(a(p)), cos_a = std::cos(a(p));
        const double sin_b = std::sin(b(p)), cos_b = std::cos(b(p));
        return {amplitude * sin_a * cos_b + offset,
                amplitude * Point<3>(2.0 * cos_a * cos_b, cos_a * cos_b - sin_a * sin_b,
                                     3.0 * sin_a * sin_b)};
      },
      .load =
          [=](const Point<3>& p) {
            return amplitude *
                   (15.0 * std::sin(a(p)) * std::cos(b(p)) + 2.0 * std::cos(a(p)) * std::sin(b(p)));
          }};
}

const RegisteredSolution<3> registered(volume_solution());

}  // namespace

}  // namespace smoothfem
