// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "smoothing/loop/problem.h"

namespace smoothfem {

/// Compares the gradient of the energy of a solver that is prepared for the mesh with differences.
template <int dim>
void expect_gradient_of_differences(ProblemSolver<dim>& solver, const Mesh<dim>& mesh) {
  const auto direction = [](NodeIndex i) {
    Point<dim> d;
    for (int k = 0; k < dim; ++k) d[k] = std::sin(1.0 + 3.0 * i + 5.0 * k);
    return d;
  };
  const auto& free_nodes = mesh.topology().free_nodes();
  const auto moved = [&](double t) {
    auto x = mesh.copied_coordinates();
    for (const NodeIndex i : free_nodes) x[i] += t * direction(i);
    return x;
  };
  // Sixth order: errors of rounding and of the formula are both far below the tolerance.
  constexpr double h = 1e-3;
  const auto difference = [&](double t) {
    return solver.solve(moved(t)) - solver.solve(moved(-t));
  };
  const double slope =
      (45.0 * difference(h) - 9.0 * difference(2.0 * h) + difference(3.0 * h)) / (60.0 * h);
  solver.solve(mesh.coordinates());
  const auto gradient = solver.energy_gradient();
  double derivative = 0.0, scale = 0.0;
  for (const NodeIndex i : free_nodes) {
    derivative += gradient[i].dot(direction(i));
    scale += gradient[i].norm() * direction(i).norm();
  }
  EXPECT_NEAR(derivative, slope, 1e-6 * scale);
}

}  // namespace smoothfem
