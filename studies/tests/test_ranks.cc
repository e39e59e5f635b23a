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

TEST_F(SmallResume, MeshesInPartsAreTheSameOnAnyNumberOfRanks) {
  const auto on = [&](int n_ranks, std::vector<std::string> arguments) {
    auto words = mpirun_on(n_ranks);
    words.push_back(SMOOTHFEM_PROGRAM);
    words.insert(words.end(), arguments.begin(), arguments.end());
    words.push_back("--quiet");
    return run(words);
  };
  const auto path = [&](const std::string& name) { return file(name).string(); };
  ASSERT_EQ(on(2, {"generate", "box", "--cells", "5,4,6", "--displacement", "0.16", "--pieces", "3",
                   "-o", path("box.pvtu")}),
            0);
  const std::string single = "grid.mesh";  // a mesh in one file
  for (const int n : {1, 2}) {
    const std::string number = std::to_string(n);
    ASSERT_EQ(on(n, {"smooth", path("box.pvtu"), "-m", "getme-simultaneous", "-o",
                     path("all" + number + ".pvtu")}),
              0);
    ASSERT_EQ(on(n, {"smooth", path(single), "-m", "smart-laplace", "-o",
                     path("one" + number + ".mesh")}),
              0);
  }
  EXPECT_EQ(content_of(file("one2.mesh")), content_of(file("one1.mesh")));
  EXPECT_NE(content_of(file("one2.mesh")), content_of(file(single)));
  for (const std::string number : {"0", "1", "2"})
    EXPECT_EQ(content_of(file("all2/all2_000" + number + ".vtu")),
              content_of(file("all1/all1_000" + number + ".vtu")));
  EXPECT_EQ(on(2, {"smooth", path("box.pvtu"), "-m", "energy-descent", "-o", path("no.pvtu")}), 2);
  EXPECT_FALSE(fs::exists(file("no.pvtu")));
}

}  // namespace
}  // namespace smoothfem
