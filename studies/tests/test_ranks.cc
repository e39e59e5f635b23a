// SPDX-License-Identifier: GPL-3.0-or-later
// Studies on several ranks. They need all cores for themselves.
#include <map>
#include <sstream>

#include "studies/framework/results/csv_text.h"
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

/// The rows of a log, by the names of their columns; without times.
std::vector<std::map<std::string, std::string>> rows_of_log(const std::string& text) {
  std::vector<std::map<std::string, std::string>> rows;
  std::vector<std::string> names;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const auto fields = csv_fields(line);
    if (names.empty()) {
      names = fields;
      continue;
    }
    auto& row = rows.emplace_back();
    for (std::size_t k = 0; k < fields.size(); ++k)
      if (!names[k].ends_with("_seconds")) row[names[k]] = fields[k];
  }
  return rows;
}

TEST_F(SmallResume, RecordsOfMeshesInPartsGoOnAfterAnInterruption) {
  const auto on = [&](int n_ranks, const std::string& log, const std::string& solution,
                      std::vector<std::string> more = {}) {
    auto words = mpirun_on(n_ranks);
    for (const std::string& word :
         std::vector<std::string>{SMOOTHFEM_PROGRAM, "smooth", "grid.mesh", "-m", "smart-laplace",
                                  "--set", "max_iterations=3", "-o", file("out.mesh").string(),
                                  "--log", file(log).string(), "--solution", solution, "--quiet"})
      words.push_back(word == "grid.mesh" ? file(word).string() : word);
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  ASSERT_EQ(on(1, "one.csv", "sine"), 0);
  ASSERT_EQ(on(2, "two.csv", "sine"), 0);
  const std::string text = content_of(file("two.csv"));
  const auto one = rows_of_log(content_of(file("one.csv"))), two = rows_of_log(text);
  ASSERT_EQ(one.size(), 4u);
  ASSERT_EQ(two.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    for (const std::string column : {"iteration", "q_min", "q_mean", "n_dofs", "n_free", "status"})
      EXPECT_EQ(one[k].at(column), two[k].at(column)) << column;
    for (const std::string column : {"l2_error", "h1_error", "condition_number"})
      EXPECT_NEAR(std::stod(one[k].at(column)) / std::stod(two[k].at(column)), 1.0, 1e-4) << column;
    EXPECT_EQ(one[k].at("status"), "ok");
  }
  EXPECT_NE(one[0].at("l2_error"), one[3].at("l2_error"));

  // The rows that are left stay as they are; others are computed again.
  std::size_t end = 0;
  for (int line = 0; line < 3; ++line) end = text.find('\n', end) + 1;
  const std::string kept = text.substr(0, end);
  file_with("two.csv", kept + "smooth,grid,smart");  // the last row is torn
  ASSERT_EQ(on(2, "two.csv", "sine", {"--resume"}), 0);
  EXPECT_TRUE(content_of(file("two.csv")).starts_with(kept));
  EXPECT_EQ(rows_of_log(content_of(file("two.csv"))), two);
  file_with("two.csv", kept);
  EXPECT_EQ(on(1, "two.csv", "gear", {"--resume"}), 2);
  EXPECT_EQ(on(1, "two.csv", "sine", {"--resume", "--finite-elements", "multigrid cg=always"}), 2);
  std::string of_other = kept;
  of_other.replace(of_other.find("smart-laplace"), 13, "laplace");
  file_with("other.csv", of_other);
  EXPECT_EQ(on(1, "other.csv", "sine", {"--resume"}), 2);
  EXPECT_EQ(content_of(file("other.csv")), of_other);
  EXPECT_EQ(content_of(file("two.csv")), kept);
  EXPECT_EQ(on(1, "two.csv", "sine", {"--finite-elements", "cg tolerance=2"}), 2);
  EXPECT_EQ(on(1, "two.csv", "none"), 2);
  const std::string mesh = content_of(file("grid.mesh"));
  EXPECT_EQ(on(1, "grid.mesh", "sine"), 2);  // a log in the place of the mesh
  EXPECT_EQ(content_of(file("grid.mesh")), mesh);
  EXPECT_EQ(content_of(file("two.csv")), kept);
}

}  // namespace
}  // namespace smoothfem
