// SPDX-License-Identifier: GPL-3.0-or-later
// Collections: many meshes in one study, in parts, killed and put together.
#include <algorithm>
#include <csignal>
#include <thread>

#include "smoothing/tests/volume_meshes.h"
#include "studies/kinds/collection/collection.h"
#include "studies/kinds/collection/member_study.h"
#include "studies/kinds/collection/worker_processes.h"
#include "studies/tests/command_line.h"
#include "studies/tests/documented_columns.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;

class Collections : public CommandLine {
 protected:
  /// A study of all files in the folder `meshes`.
  void write_study(const std::string& more = {}) const {
    file_with("all.prm",
              "set kind = collection\nset collection = meshes/*\nset methods = laplace\n"
              "set degrees = 1\nset timing runs = 1\nset record every = 3\nset metrics = "
              "shape\nset refined degrees = 1\n"
              "subsection solution\n set name = sine\nend\n"
              "subsection finite elements\n set condition number = none\n"
              " set jacobi cg = never\nend\n" +
                  more);
  }

  void write_good_meshes(int n) const {
    fs::create_directories(file("meshes"));
    const std::vector<std::string> endings{".vtk", ".vtu", ".mesh", ".msh", ".inp"};
    for (int i = 0; i < n; ++i) {
      const fs::path path =
          file("meshes") / ("good" + std::to_string(i) + endings[static_cast<std::size_t>(i) % 5]);
      if (i % 10 == 9)
        write_mesh(path, test::box_mesh(
                             2, 2, 2,
                             i % 20 == 9 ? test::BoxCells::tetrahedra : test::BoxCells::hexahedra));
      else
        write_mesh(path, shaken_grid(4 + static_cast<std::size_t>(i) % 3, 0.2));
    }
  }

  CsvTable table(const std::string& path) const { return CsvTable(content_of(file(path))); }

  void expect_same_tables(const std::string& a, const std::string& b) const {
    for (const std::string name :
         {"iterations.csv", "summary.csv", "metrics.csv", "refined.csv", "members.csv"})
      EXPECT_EQ(rows_without_times(file(a) / name), rows_without_times(file(b) / name)) << name;
  }
};

TEST_F(Collections, BrokenMeshesAreRowsWithTheReasonAndCostNoOther) {
  write_good_meshes(34);
  write_study();
  file_with("meshes/rubbish.vtk", "not a mesh\n");
  file_with("meshes/empty.msh", "");
  file_with("meshes/letter.txt", "no format of meshes\n");
  write_mesh(file("meshes/tangled.vtk"), shaken_grid(4, 1.5));
  const std::string whole = content_of(file("meshes/good0.vtk"));
  file_with("meshes/cut.vtk", whole.substr(0, whole.size() / 2));
  // A pentagon is a cell that has no finite elements.
  file_with("meshes/pentagon.vtk",
            "# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n"
            "0 0 0 2 0 0 3 2 0 1 3 0 -1 2 0\nCELLS 1 6\n5 0 1 2 3 4\nCELL_TYPES 1\n7\n");
  const Outcome outcome = smoothfem({"study", "all.prm", "--out", "out", "--threads", "2"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              ::testing::HasSubstr("34 members are complete, 6 have failed; out/members.csv"));

  const CsvTable members = table("out/members.csv");
  EXPECT_EQ(members.columns, documented_columns("members.csv"));
  EXPECT_EQ(members.select({{"status", "complete"}, {"reason", ""}}).size(), 34u);
  std::set<std::string> failed;
  for (const auto& row : members.select({{"status", "failed"}})) {
    failed.insert(row.at("member"));
    EXPECT_NE(row.at("reason"), "") << row.at("member");
  }
  EXPECT_EQ(failed,
            (std::set<std::string>{"cut", "empty", "letter", "pentagon", "rubbish", "tangled"}));
  EXPECT_EQ(members.select({{"elements", "hexahedra"}, {"dimension", "3"}}).size(), 1u);
  // Of each member the initial mesh and the result of each method.
  EXPECT_EQ(table("out/summary.csv").rows.size(), 34u * 2);
  const CsvTable iterations = table("out/iterations.csv");
  std::set<std::string> with_rows;
  for (const auto& row : iterations.rows) with_rows.insert(row.at("member"));
  EXPECT_EQ(with_rows.size(), 34u);
  // What stands before the members' own columns.
  const auto own = documented_columns("iterations.csv");
  EXPECT_EQ(std::vector(iterations.columns.begin() + 8, iterations.columns.end()), own);

  const Outcome again = smoothfem({"study", "all.prm", "--out", "out"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.err, ::testing::HasSubstr("nothing to do"));
}

TEST_F(Collections, ShardsPutTogetherAreTheWhole) {
  write_good_meshes(5);
  write_study(
      "set solutions = sine, wave\nset domains = gear: 6\nset elements = triangles\n"
      "set distortions = 0.6\nset seeds = 1, 2\n"
      "subsection solution wave\n set u = sin(3*X)*cos(2*Y) + Z\nend\n");
  ASSERT_EQ(smoothfem({"study", "all.prm", "--out", "whole", "--quiet"}).exit_code, 0);
  const CsvTable whole = table("whole/members.csv");
  EXPECT_EQ(whole.rows.size(), 14u);
  EXPECT_EQ(whole.select({{"status", "complete"}}).size(), 14u);
  std::size_t n_members = 0;
  for (const std::string part : {"1", "2"}) {
    const Outcome outcome =
        smoothfem({"study", "all.prm", "--out", "part" + part, "--shard", part + "/2", "--quiet"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    n_members += table("part" + part + "/members.csv").rows.size();
  }
  EXPECT_EQ(n_members, 14u);
  ASSERT_EQ(smoothfem({"merge", "part2", "part1", "--out", "both"}).exit_code, 0);
  expect_same_tables("whole", "both");
  const Outcome again = smoothfem({"study", "all.prm", "--out", "both"});
  EXPECT_THAT(again.err, ::testing::HasSubstr("nothing to do"));
  const Outcome taken = smoothfem({"merge", "part2", "part1", "--out", "both"});
  EXPECT_EQ(taken.exit_code, 2);
  EXPECT_THAT(taken.err, ::testing::HasSubstr("both is there already"));
}

TEST_F(Collections, KilledOnesGoOn) {
  write_good_meshes(8);
  write_study("set solutions = sine, linear\n");
  ASSERT_EQ(smoothfem({"study", "all.prm", "--out", "unbroken", "--quiet"}).exit_code, 0);
  bool was_half_done = false;
  for (int i = 0; i < 4; ++i) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::execl(SMOOTHFEM_PROGRAM, SMOOTHFEM_PROGRAM, "study", file("all.prm").c_str(), "--out",
              file("killed").c_str(), "--quiet", nullptr);
      ::_exit(127);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(400 + 300 * i));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const auto files = files_in(file("killed"));
    was_half_done = was_half_done || (!files.empty() && !files.contains("members.csv"));
  }
  EXPECT_TRUE(was_half_done) << "no kill has hit a run with something to go on from";
  ASSERT_EQ(smoothfem({"study", "all.prm", "--out", "killed", "--quiet"}).exit_code, 0);
  expect_same_tables("unbroken", "killed");
}

TEST_F(Collections, WhatCannotBeIsRefused) {
  write_good_meshes(1);
  const auto refused = [&](const std::string& more, const std::string& why) {
    write_study(more);
    const Outcome outcome = smoothfem({"study", "all.prm", "--out", "out"});
    EXPECT_EQ(outcome.exit_code, 2) << more;
    EXPECT_THAT(outcome.err, ::testing::HasSubstr(why)) << more;
    EXPECT_FALSE(fs::exists(file("out"))) << more;
  };
  refused("set meshes = one\n", "a collection has no list 'meshes'");
  refused("set collection = none/*.vtk\n", "there is no such file");
  refused("set domains = geer\n", "did you mean 'gear'?");
  refused("set domains = gear: x\n", "write NAME, or NAME: FACTOR");
  refused("set domains = ring\nset elements = triangles\n", "has none of the elements triangles");
  refused("set distorsions = 0.5\n", "distorsions");
  refused("set solutions = a b\n", "the solution label 'a b'");
  refused("set collection = meshes/*, meshes/*\nset solutions = sine, sine\n", "two members");
  write_study();
  for (const std::string shard : {"0/2", "3/2", "1", "x/y"}) {
    const Outcome outcome = smoothfem({"study", "all.prm", "--shard", shard});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, ::testing::HasSubstr("--shard is '" + shard + "'"));
  }
  const Outcome other = smoothfem({"study", "gear", "--shard", "1/2"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, ::testing::HasSubstr("--shard is for collections"));
  const Outcome merged = smoothfem({"merge", "meshes", "--out", "merged"});
  EXPECT_EQ(merged.exit_code, 2);
  EXPECT_THAT(merged.err, ::testing::HasSubstr("has no results of a collection"));
  EXPECT_FALSE(fs::exists(file("merged")));
}

TEST(WorkerProcesses, ATaskThatCrashesCostsNoOther) {
  std::map<std::size_t, std::string> outcomes, failures;
  run_in_workers(
      20, 3,
      [] {
        return [](std::size_t task) -> std::string {
          if (task == 4) std::raise(SIGKILL);
          if (task == 7) throw std::runtime_error("two\nlines");
          return "task " + std::to_string(task);
        };
      },
      [&](const TaskEnd& end) {
        (end.failure.empty() ? outcomes : failures)[end.task] = end.outcome + end.failure;
      },
      [] {});
  EXPECT_EQ(outcomes.size(), 18u);
  EXPECT_EQ(outcomes[19], "task 19");
  ASSERT_EQ(failures.size(), 2u);
  EXPECT_EQ(failures[4], "the process that worked on it was killed: Killed");
  EXPECT_EQ(failures[7], "two lines");
}

TEST(Shard, EveryMemberIsInOnePart) {
  Member member;
  for (int i = 0; i < 50; ++i) {
    member.mesh.name = "mesh" + std::to_string(i);
    int n_parts = 0;
    for (unsigned int k = 1; k <= 7; ++k) n_parts += Shard{k, 7}.holds(member) ? 1 : 0;
    EXPECT_EQ(n_parts, 1);
  }
}

TEST(InBox, CoordinatesGoFromZeroToOneAlongTheLongestSide) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-1.0, 2.0, 0.0), Eigen::Vector3d(3.0, 4.0, 0.0));
  EXPECT_EQ(in_box("exp(X) + x*Y - Z", box), "exp(((x - (-1)) / 4)) + x*((y - (2)) / 4) - 0");
}

}  // namespace
}  // namespace smoothfem
