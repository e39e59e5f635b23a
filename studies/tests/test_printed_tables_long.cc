// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/tests/printed_tables.h"

namespace smoothfem {
namespace {

TEST_F(PrintedTables, InitialTrianglesOfDegree2) {
  // The condition number is 1.5e9, so the printed errors are those of the iterate at which CG
  // stopped (deviations.csv).
  expect_printed_solution("tri", "initial", 2, solve(published("tri"), 2),
                          {.cg_iterations = 0.06, .errors = 0.03});
}

}  // namespace
}  // namespace smoothfem
