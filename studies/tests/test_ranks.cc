// SPDX-License-Identifier: GPL-3.0-or-later
// Studies on several ranks. They need all cores for themselves.
#include "studies/tests/resume_tests.h"

namespace smoothfem {
namespace {

class SmallResume : public Resume {
 protected:
  SmallResume() : Resume("1", 4) {}
};

TEST_F(SmallResume, RowsOnTwoRanksAreThoseOfOneProcess) {
  expect_same_rows_on_ranks("volume", {2});
}

TEST_F(SmallResume, RowsOfOtherSolversOnTwoRanksAreThoseOfOneProcess) {
  write_solver_study("solvers.prm");
  expect_same_rows_on_ranks("solvers", {2});
}

TEST_F(SmallResume, RowsOfSolutionAdaptiveMethodsOnTwoRanksAreThoseOfOneProcess) {
  expect_same_rows_on_ranks("moving", {2});
}

}  // namespace
}  // namespace smoothfem
