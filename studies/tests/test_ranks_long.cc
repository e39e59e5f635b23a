// SPDX-License-Identifier: GPL-3.0-or-later
// Studies on three ranks, which may be more than the cores, with quadratic elements and larger
// boxes.
#include "studies/tests/resume_tests.h"

namespace smoothfem {
namespace {

TEST_F(Resume, RowsOnTwoAndThreeRanksAreThoseOfOneProcess) {
  expect_same_rows_on_ranks("volume", {2, 3});
}

TEST_F(Resume, RowsOfSolutionAdaptiveMethodsOnTwoAndThreeRanksAreThoseOfOneProcess) {
  expect_same_rows_on_ranks("moving", {2, 3});
}

}  // namespace
}  // namespace smoothfem
