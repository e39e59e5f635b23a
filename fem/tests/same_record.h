// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fem/solution_record.h"

namespace smoothfem {

inline void expect_relative(double value, double expected, double tolerance, const char* what) {
  EXPECT_NEAR(value / expected, 1.0, tolerance) << what;
}

/// Iteration counts depend on rounding.
inline void expect_close(std::size_t value, std::size_t expected) {
  const double difference = std::abs(static_cast<double>(value) - static_cast<double>(expected));
  EXPECT_LE(difference, std::max(1.0, 0.01 * static_cast<double>(expected)));
}

inline void expect_same(const SolutionRecord& record, const SolutionRecord& alone) {
  EXPECT_EQ(record.n_dofs, alone.n_dofs);
  EXPECT_EQ(record.n_free, alone.n_free);
  EXPECT_EQ(record.status, alone.status);
  EXPECT_TRUE(record.cg_converged);
  expect_relative(record.e_max, alone.e_max, 1e-8, "e_max");
  expect_relative(record.e_mean, alone.e_mean, 1e-8, "e_mean");
  expect_relative(record.e_l2, alone.e_l2, 1e-8, "e_l2");
  expect_relative(record.e_h1, alone.e_h1, 1e-8, "e_h1");
  expect_relative(record.l2_error, alone.l2_error, 1e-8, "l2_error");
  expect_relative(record.h1_error, alone.h1_error, 1e-8, "h1_error");
  expect_relative(record.condition_number, alone.condition_number, 1e-6, "condition number");
  EXPECT_LE(record.condition_residual, 1e-6);
  expect_close(record.cg_iterations, alone.cg_iterations);
  expect_close(record.jacobi_cg_iterations, alone.jacobi_cg_iterations);
}

}  // namespace smoothfem
