// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/solve_costs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace smoothfem {
namespace {

/// A study of two meshes and degrees, and of methods of which each solve takes another time, the
/// initial meshes by far the longest, on a machine that is not the one the first guess is made for.
struct SimulatedStudy {
  struct Task {
    SolveKind kind;
    double seconds;
  };
  std::vector<Task> tasks;

  explicit SimulatedStudy(int dimension, double machine) {
    const double nodes[] = {7660.0, 30000.0}, of_method[] = {13.0, 1.0, 0.8, 0.9, 1.3};
    const std::size_t n_records[] = {1, 80, 25, 400, 60};
    std::mt19937 random(3);
    for (std::size_t mesh = 0; mesh < 2; ++mesh)
      for (std::size_t degree = 0; degree < 2; ++degree)
        for (std::size_t method = 0; method < 5; ++method)
          for (std::size_t i = 0; i < n_records[method]; ++i) {
            const double scatter = std::exp2((random() / 4294967296.0 - 0.5) * 0.5);
            const SolveKind kind{mesh,
                                 method,
                                 degree,
                                 method == 0,
                                 i + 1 == n_records[method],
                                 nodes[mesh],
                                 dimension,
                                 static_cast<int>(degree) + 1};
            const double n_dofs =
                nodes[mesh] * std::pow(1.0 + static_cast<double>(degree), dimension);
            const double seconds = machine * std::pow(n_dofs, 1.4) * of_method[method] * scatter *
                                   (kind.is_result ? 3.0 : 1.0);
            tasks.push_back({kind, seconds});
          }
  }

  /// How far the estimate of the time left is off at worst, once this share of the time is over.
  double worst_factor(double from) const {
    SolveCosts costs;
    double total = 0.0, spent = 0.0, worst = 1.0;
    for (const Task& task : tasks) {
      total += task.seconds;
      costs.expect(task.kind);
    }
    for (std::size_t i = 0; i + 1 < tasks.size(); ++i) {
      costs.forget(tasks[i].kind);
      costs.add(tasks[i].kind, tasks[i].seconds);
      spent += tasks[i].seconds;
      if (spent < from * total) continue;
      const double ratio = costs.seconds_to_come() / (total - spent);
      worst = std::max({worst, ratio, 1.0 / ratio});
    }
    return worst;
  }
};

TEST(SolveCosts, TimeLeftIsKnownFromAFifthOn) {
  for (const int dimension : {2, 3})
    for (const double machine : {1e-9, 1e-7, 1e-5})
      EXPECT_LT(SimulatedStudy(dimension, machine).worst_factor(0.2), 1.5) << dimension;
}

TEST(SolveCosts, WhatIsKnownIsItsMean) {
  SolveCosts costs;
  const SolveKind kind{0, 0, 0, false, false, 1000.0, 2, 1};
  costs.add(kind, 2.0);
  costs.add(kind, 4.0);
  EXPECT_DOUBLE_EQ(costs.expected(kind), 3.0);
}

TEST(SolveCosts, LargerSystemsTakeLonger) {
  const SolveCosts costs;
  const SolveKind small{0, 0, 0, false, false, 1000.0, 3, 1},
      large{0, 0, 0, false, false, 2000.0, 3, 1};
  SolveKind quadratic = small;
  quadratic.polynomial_degree = 2;
  EXPECT_GT(costs.expected(large), 2.0 * costs.expected(small));
  EXPECT_GT(costs.expected(quadratic), 8.0 * costs.expected(small));
}

}  // namespace
}  // namespace smoothfem
