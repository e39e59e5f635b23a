// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/solve_costs.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <tuple>
#include <vector>

namespace smoothfem {
namespace {

/// A study of two meshes and two degrees. Each method's solves take a different time, and initial
/// meshes take by far the longest. The machine is not the one that the first guess is made for.
struct SimulatedStudy {
  struct Task {
    SolveKind kind;
    double seconds;
  };
  std::vector<Task> tasks;

  /// unlike: factor by which the second degree and initial meshes are cheaper on the second mesh
  /// than on the first, compared with the others. An example is hexahedra compared with tetrahedra.
  /// Early records cost more by the same factor.
  explicit SimulatedStudy(int dimension, double machine, double unlike = 1.0) {
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
                                 static_cast<int>(degree) + 1,
                                 i};
            const double n_dofs =
                nodes[mesh] * std::pow(1.0 + static_cast<double>(degree), dimension);
            const double seconds = machine * std::pow(n_dofs, 1.4) * of_method[method] * scatter *
                                   (kind.is_result ? 3.0 : 1.0);
            const bool cheaper = mesh == 1 && (degree == 1 || method == 0);
            const double early =
                6.0 * static_cast<double>(i) / static_cast<double>(n_records[method]);
            tasks.push_back({kind, seconds / (cheaper ? unlike : 1.0) *
                                       (1.0 + (unlike - 1.0) * std::exp(-early))});
          }
  }

  /// The tasks in the order of a study.
  SimulatedStudy representatives_first() const {
    SimulatedStudy sorted = *this;
    std::vector<Task> others;
    sorted.tasks.clear();
    for (std::size_t begin = 0, end = 0; begin < tasks.size(); begin = end) {
      const auto job = [&](std::size_t i) {
        return std::tuple(tasks[i].kind.mesh, tasks[i].kind.degree, tasks[i].kind.method);
      };
      while (end < tasks.size() && job(end) == job(begin)) ++end;
      const auto representative = representative_records(end - begin);
      for (std::size_t i = begin; i < end; ++i)
        (i - begin == representative[0] || i - begin == representative[1] ? sorted.tasks : others)
            .push_back(tasks[i]);
    }
    sorted.tasks.insert(sorted.tasks.end(), others.begin(), others.end());
    return sorted;
  }

  /// Returns the worst factor by which the estimate of the remaining time is wrong, between these
  /// shares of the time.
  double worst_factor(double from, double until = 1.0) const {
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
      if (spent < from * total || spent > until * total) continue;
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

TEST(SolveCosts, RepresentativeRecordsGiveTheMeanOfTheirJob) {
  EXPECT_EQ(representative_records(1), (std::array<std::size_t, 2>{0, 0}));
  EXPECT_EQ(representative_records(2), (std::array<std::size_t, 2>{0, 1}));
  EXPECT_EQ(representative_records(10), (std::array<std::size_t, 2>{2, 7}));
  EXPECT_EQ(representative_records(28), (std::array<std::size_t, 2>{5, 22}));
}

TEST(SolveCosts, LearnsUnusualCostsFromTheirFirstRecords) {
  const SimulatedStudy study(3, 1e-7, 5.0);
  EXPECT_GT(study.worst_factor(0.2), 1.5) << "nothing to be learned";
  EXPECT_LT(study.representatives_first().worst_factor(0.2, 0.99), 1.5);  // then it is one record's
}

TEST(SolveCosts, RecordsLieBetweenKnownOnes) {
  SolveCosts costs;
  const auto kind = [](std::size_t record) {
    return SolveKind{0, 0, 0, false, false, 1000.0, 2, 1, record};
  };
  costs.add(kind(3), 2.0);
  costs.add(kind(7), 4.0);
  EXPECT_DOUBLE_EQ(costs.expected(kind(4)), 2.5);
  EXPECT_DOUBLE_EQ(costs.expected(kind(1)), 2.0);
  EXPECT_DOUBLE_EQ(costs.expected(kind(9)), 4.0);
  EXPECT_DOUBLE_EQ(costs.expected(kind(7)), 4.0);
  for (const std::size_t record : {4, 5, 9}) costs.expect(kind(record));
  costs.forget(kind(5));
  EXPECT_DOUBLE_EQ(costs.seconds_to_come(), 2.5 + 4.0);
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
