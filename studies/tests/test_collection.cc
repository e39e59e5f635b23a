// SPDX-License-Identifier: GPL-3.0-or-later
// Collections: many meshes in one study, run in parts, killed and merged.
#include <algorithm>
#include <csignal>
#include <thread>

#include "smoothing/tests/volume_meshes.h"
#include "studies/framework/results/folder_lock.h"
#include "studies/kinds/collection/definition/collection.h"
#include "studies/kinds/collection/member_study.h"
#include "studies/kinds/collection/tasks/task_process.h"
#include "studies/tests/command_line.h"
#include "studies/tests/documented_columns.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;

class Collections : public CommandLine {
 protected:
  /// Writes a study of all files in the folder `meshes`.
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

TEST_F(Collections, BrokenMeshesAreRowsWithTheReason) {
  write_good_meshes(20);
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
              ::testing::HasSubstr("20 members are complete, 6 have failed; out/members.csv"));

  const CsvTable members = table("out/members.csv");
  EXPECT_EQ(members.columns, documented_columns("members.csv"));
  EXPECT_EQ(members.select({{"status", "complete"}, {"reason", ""}}).size(), 20u);
  std::set<std::string> failed;
  for (const auto& row : members.select({{"status", "failed"}})) {
    failed.insert(row.at("member"));
    EXPECT_NE(row.at("reason"), "") << row.at("member");
  }
  EXPECT_EQ(failed,
            (std::set<std::string>{"cut", "empty", "letter", "pentagon", "rubbish", "tangled"}));
  EXPECT_EQ(members.select({{"elements", "hexahedra"}, {"dimension", "3"}}).size(), 1u);
  // Each member has rows for the initial mesh and for the result of each method.
  EXPECT_EQ(table("out/summary.csv").rows.size(), 20u * 2);
  const CsvTable iterations = table("out/iterations.csv");
  std::set<std::string> with_rows;
  for (const auto& row : iterations.rows) with_rows.insert(row.at("member"));
  EXPECT_EQ(with_rows.size(), 20u);
  // Columns before the members' own columns.
  const auto own = documented_columns("iterations.csv");
  EXPECT_EQ(std::vector(iterations.columns.begin() + 8, iterations.columns.end()), own);

  const Outcome again = smoothfem({"study", "all.prm", "--out", "out"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.err, ::testing::HasSubstr("nothing to do"));
}

TEST_F(Collections, SolversThatFailOnAMemberLeaveItsFieldsEmpty) {
  fs::create_directories(file("meshes"));
  write_mesh(file("meshes/a.mesh"), shaken_grid(6, 0.2));
  write_mesh(file("meshes/b.mesh"), shaken_grid(3, 0.2));
  file_with(
      "all.prm",
      "set kind = collection\nset collection = meshes/*\nset methods = laplace\n"
      "set timing runs = 1\nset solvers = small, beam\n"
      "subsection solver beam\n set type = elasticity\n set degrees = 1\n set u = x*y ; x\nend\n"
      "subsection solver small\n"
      " set command = sh -c 'test $(wc -l < {in}) -lt 60 && echo n 7, m 8' {in}\n"
      " set format = mesh\n set number n = n ([0-9]+)\n set number m = m ([0-9]+)\nend\n");
  const Outcome outcome = smoothfem({"study", "all.prm", "--out", "out", "--no-figures"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const CsvTable summary = table("out/summary.csv");
  const auto failed = summary.select({{"member", "a"}}), solved = summary.select({{"member", "b"}});
  ASSERT_EQ(failed.size(), 2u);
  ASSERT_EQ(solved.size(), 2u);
  EXPECT_EQ(failed[1].at("small.n"), "");
  EXPECT_THAT(failed[1].at("status"),
              ::testing::HasSubstr("small: failed: it ended with exit code"));
  EXPECT_EQ(solved[1].at("small.n"), "7");
  EXPECT_EQ(solved[1].at("small.m"), "8");
  EXPECT_LT(std::stod(failed[1].at("beam.energy_error")), 1.0);
  EXPECT_EQ(solved[1].at("status"), "ok");
}

TEST_F(Collections, FilesAreDistortedForEachSeed) {
  fs::create_directories(file("meshes"));
  write_mesh(file("meshes/grid.vtk"), shaken_grid(5, 0.2));
  const std::string content = content_of(file("meshes/grid.vtk"));
  const auto study_with = [&](const std::string& more) {
    file_with("all.prm",
              "set kind = collection\nset collection = meshes/*\nset methods = laplace\n"
              "set degrees =\nset timing runs = 1\nset seeds = 1, 2\n" +
                  more);
    return smoothfem({"study", "all.prm", "--out", "out"});
  };
  const std::string distortions = "set distortions = none, 0.6, 0.999\n";
  EXPECT_THAT(study_with(distortions).err,
              ::testing::HasSubstr("3 members are complete, 2 have failed"));
  const CsvTable members = table("out/members.csv");
  std::set<std::string> names;
  for (const auto& row : members.rows) names.insert(row.at("member"));
  EXPECT_EQ(names, (std::set<std::string>{"grid", "grid.q0.6.r1", "grid.q0.6.r2", "grid.q0.999.r1",
                                          "grid.q0.999.r2"}));
  EXPECT_EQ(members.select({{"member", "grid"}, {"seed", ""}, {"distortion", ""}}).size(), 1u);
  const auto distorted = members.select({{"distortion", "0.6"}, {"status", "complete"}});
  ASSERT_EQ(distorted.size(), 2u);
  for (const auto& row : distorted) EXPECT_NEAR(std::stod(row.at("q_mean")), 0.6, 1e-3);
  EXPECT_EQ(distorted[1].at("seed"), "2");
  EXPECT_NE(distorted[0].at("q_min"), distorted[1].at("q_min"));
  for (const auto& row : members.select({{"distortion", "0.999"}}))
    EXPECT_THAT(row.at("reason"), ::testing::HasSubstr("because the mesh itself has"));
  EXPECT_EQ(content_of(file("meshes/grid.vtk")), content);
  EXPECT_THAT(smoothfem({"study", "all.prm", "--dry-run"}).out,
              ::testing::HasSubstr("    5 from 1 mesh file; as they are; distorted to 0.6, 0.999; "
                                   "seeds 1, 2\n"));

  // Families change no mesh. Without distortions the seeds change nothing, which is said.
  EXPECT_EQ(members.select({{"family", "meshes"}}).size(), 5u);
  EXPECT_EQ(study_with(distortions + "set families by = file\n").exit_code, 0);
  EXPECT_EQ(table("out/members.csv").select({{"family", "grid"}}).size(), 5u);
  EXPECT_THAT(study_with("").err, ::testing::HasSubstr("'seeds' changes nothing"));
  const Outcome refused = study_with("set distortions = much\n");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, ::testing::HasSubstr("all.prm:7: 'distortions' has 'much'"));
}

TEST_F(Collections, AlgorithmsAreThoseOfMeshesAsTheyAre) {
  file_with("all.prm",
            "set kind = collection\nset domains = disc: 16, square: 24\nset methods = laplace\n"
            "set degrees =\nset algorithms = frontal, delaunay\nset distortions = none, 0.6\n"
            "set elements = triangles\n");
  std::set<std::string> names;
  for (const Member& member : read_collection(file("all.prm")).members)
    names.insert(member.name + " " + member.mesh.algorithm);
  EXPECT_EQ(names, (std::set<std::string>{"disc.triangles.s1.delaunay delaunay",
                                          "disc.triangles.s1.frontal frontal",
                                          "disc.triangles.s1.frontal.q0.6 frontal",
                                          "square.triangles.s1 ", "square.triangles.s1.q0.6 "}));
}

TEST_F(Collections, EpsMakesMeshesOfDomainsThatHaveIt) {
  file_with("all.prm",
            "set kind = collection\nset domains = kershaw: 8, square: 24\nset methods = laplace\n"
            "set degrees =\nset eps = 0.3, 1\nset elements = quadrilaterals\n");
  const Collection collection = read_collection(file("all.prm"));
  std::map<std::string, double> eps;
  for (const Member& member : collection.members) eps[member.name] = member.mesh.eps;
  EXPECT_EQ(eps, (std::map<std::string, double>{{"kershaw.quadrilaterals.s1.e0.3", 0.3},
                                                {"kershaw.quadrilaterals.s1.e1", 1.0},
                                                {"square.quadrilaterals.s1", 0.0}}));
  const Outcome outcome = smoothfem({"study", "all.prm", "--out", "out", "--quiet"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const CsvTable members = table("out/members.csv");
  EXPECT_EQ(members.select({{"family", "kershaw"}, {"n_nodes", "49"}}).size(), 2u);
  EXPECT_LT(std::stod(members.rows[0].at("q_min")), 0.9);
  EXPECT_EQ(std::stod(members.rows[1].at("q_min")), 1.0);
  file_with("all.prm", content_of(file("all.prm")) + "set eps = 0\n");
  EXPECT_THAT(smoothfem({"study", "all.prm"}).err,
              ::testing::HasSubstr("eps of the domain 'kershaw' is 0; give a number above 0"));
}

TEST_F(Collections, TangledMeshesAreUntangledOnRequest) {
  fs::create_directories(file("meshes"));
  write_mesh(file("meshes/tangled.vtk"), shaken_grid(4, 1.5));
  write_mesh(file("meshes/valid.vtk"), shaken_grid(4, 0.2));
  write_study("set untangle = true\n");
  for (const std::string run : {"first", "again"}) {  // the second takes the kept meshes
    const std::vector<std::string> more =
        run == "first" ? std::vector<std::string>{} : std::vector<std::string>{"--retime"};
    std::vector<std::string> words{"study", "all.prm", "--out", "out", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = smoothfem(words);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const CsvTable members = table("out/members.csv");
    ASSERT_EQ(members.select({{"status", "complete"}}).size(), 2u) << run;
    EXPECT_GT(std::stod(members.rows[0].at("q_min")), 0.0);
    EXPECT_THAT(
        content_of(file("out/members/tangled/provenance.json")),
        ::testing::ContainsRegex("untangled, as [0-9]+ of 16 cells of the file are invalid"));
    EXPECT_THAT(content_of(file("out/members/valid/provenance.json")),
                ::testing::Not(::testing::HasSubstr("untangled")));
  }
  write_study();
  ASSERT_EQ(smoothfem({"study", "all.prm", "--out", "out", "--quiet"}).exit_code, 0);
  EXPECT_EQ(table("out/members.csv").select({{"member", "tangled"}, {"status", "failed"}}).size(),
            1u);
}

/// A data folder with the set `few` of two meshes and the studies `some` and `some-few`.
class PublishedSets : public Collections {
 protected:
  void SetUp() override {
    const fs::path studies = file("data/studies"), own = fs::path(SMOOTHFEM_SOURCE_DIR) / "studies";
    fs::create_directories(studies / "published");
    fs::create_directories(studies / "catalogue" / "any");
    fs::create_directory_symlink(own / "presets", studies / "presets");
    file_with("data/studies/published/few.json",
              R"({"files": {"2d/a.vtk": {"family": "one"}, "b.vtk": {"family": "one"}}})");
    write_study("set published = few\n");
    fs::rename(file("all.prm"), studies / "catalogue" / "any" / "some-few.prm");
    std::string text = content_of(studies / "catalogue" / "any" / "some-few.prm");
    text.erase(text.find("set collection"), std::string("set collection = meshes/*\n").size());
    file_with("data/studies/catalogue/any/some-few.prm", text);
    ::setenv("SMOOTHFEM_DATA", file("data").c_str(), 1);
  }
  void TearDown() override {
    ::unsetenv("SMOOTHFEM_DATA");
    Collections::TearDown();
  }

  void expect_refused(const std::vector<std::string>& words, const std::string& part) const {
    const Outcome outcome = smoothfem(words);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, ::testing::HasSubstr(part));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(file("results")));
  }
};

TEST_F(PublishedSets, HaveTheFamiliesOfTheirCatalogue) {
  fs::create_directories(file("fetched/few/2d"));
  write_mesh(file("fetched/few/2d/a.vtk"), shaken_grid(4, 0.2));
  expect_refused({"study", "some-few", "--mesh-dir", "fetched"}, "has no file fetched/few/b.vtk");
  write_mesh(file("fetched/few/b.vtk"), shaken_grid(5, 0.2));
  const Outcome outcome = smoothfem({"study", "some-few", "--mesh-dir", "fetched", "--quiet"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const CsvTable members = table("results/some-few/members.csv");
  EXPECT_EQ(members.select({{"status", "complete"}, {"family", "one"}}).size(), 2u);
  EXPECT_EQ(members.rows[0].at("file"), "a.vtk");
  // A member that is gone leaves no row.
  file_with("data/studies/published/few.json", R"({"files": {"b.vtk": {"family": "one"}}})");
  ASSERT_EQ(smoothfem({"study", "some-few", "--mesh-dir", "fetched", "--quiet"}).exit_code, 0);
  EXPECT_EQ(table("results/some-few/members.csv").rows.size(), 1u);
  // From another folder they are the same.
  fs::rename(file("fetched"), file("elsewhere"));
  EXPECT_THAT(smoothfem({"study", "some-few", "--mesh-dir", "elsewhere"}).err,
              ::testing::HasSubstr("nothing to do"));
}

TEST_F(PublishedSets, AreNamedOnTheCommandLine) {
  const Outcome plan = smoothfem({"study", "some", "--published", "few", "--dry-run"});
  EXPECT_EQ(plan.exit_code, 0) << plan.err;
  EXPECT_THAT(plan.out, ::testing::HasSubstr("2 members in 1 family"));
  const Outcome launcher = smoothfem({"study", "some", "--published", "few", "--print-plan"});
  EXPECT_THAT(launcher.out, ::testing::HasSubstr("out results/some-few\n"));
  EXPECT_THAT(launcher.out, ::testing::HasSubstr("\nfetch some-few\n"));
  EXPECT_TRUE(launcher.out.starts_with("set few\n")) << launcher.out;
  // The name of a study may follow the option.
  EXPECT_EQ(smoothfem({"study", "--published", "some-few", "--print-plan"}).out, launcher.out);
  expect_refused({"study", "some", "--published", "fewer"},
                 "there is no published set 'fewer'; choose one of few");
  expect_refused({"study", "some-few", "--published", "few"}, "no sets of published meshes");
  expect_refused({"study", "some-few"}, "some-few needs published meshes; add --published");
}

TEST_F(Collections, MergedShardsAreTheWhole) {
  write_good_meshes(1);
  write_study(
      "set solutions = sine, wave\nset domains = gear: 6\nset elements = triangles\n"
      "set distortions = 0.6\nset seeds = 1, 2\n"
      "subsection solution wave\n set u = sin(3*X)*cos(2*Y) + Z\nend\n");
  ASSERT_EQ(smoothfem({"study", "all.prm", "--out", "whole", "--quiet"}).exit_code, 0);
  const CsvTable whole = table("whole/members.csv");
  EXPECT_EQ(whole.rows.size(), 8u);
  EXPECT_EQ(whole.select({{"status", "complete"}}).size(), 8u);
  std::size_t n_members = 0;
  for (const std::string part : {"1", "2"}) {
    const Outcome outcome =
        smoothfem({"study", "all.prm", "--out", "part" + part, "--shard", part + "/2", "--quiet"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    n_members += table("part" + part + "/members.csv").rows.size();
  }
  EXPECT_EQ(n_members, 8u);
  ASSERT_EQ(smoothfem({"merge", "part2", "part1", "--out", "both"}).exit_code, 0);
  expect_same_tables("whole", "both");
  const Outcome again = smoothfem({"study", "all.prm", "--out", "both"});
  EXPECT_THAT(again.err, ::testing::HasSubstr("nothing to do"));

  // Without a part, the merged folder says what it lacks, and the study completes it.
  const Outcome half = smoothfem({"merge", "part2", "part2", "--out", "half"});
  EXPECT_EQ(half.exit_code, 2);
  EXPECT_THAT(half.err, ::testing::ContainsRegex("of 8 members are not complete.*belong to 1/2"));
  EXPECT_EQ(table("half/members.csv").rows.size(), 8u);
  EXPECT_THAT(content_of(file("half/provenance.json")),
              ::testing::HasSubstr("\"status\": \"interrupted\""));
  ASSERT_EQ(smoothfem({"study", "all.prm", "--out", "half", "--quiet"}).exit_code, 0);
  expect_same_tables("whole", "half");

  // Parts of other mesh files do not belong to it.
  write_mesh(file("meshes/good0.vtk"), shaken_grid(3, 0.2));
  ASSERT_EQ(
      smoothfem({"study", "all.prm", "--out", "other1", "--shard", "1/2", "--quiet"}).exit_code, 0);
  const Outcome mixed = smoothfem({"merge", "other1", "part2", "--out", "mixed"});
  EXPECT_EQ(mixed.exit_code, 2);
  EXPECT_THAT(mixed.err, ::testing::HasSubstr("they differ in content of mesh good0"));
  const Outcome taken = smoothfem({"merge", "part2", "part1", "--out", "both"});
  EXPECT_EQ(taken.exit_code, 2);
  EXPECT_THAT(taken.err, ::testing::HasSubstr("both is there already"));
}

TEST_F(Collections, KilledRunsResume) {
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
    // Counts from the time the folder exists, because that may take long on a busy machine.
    for (int k = 0; k < 600 && !fs::exists(file("killed") / "provenance.json"); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    std::this_thread::sleep_for(std::chrono::milliseconds(200 + 300 * i));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const auto files = files_in(file("killed"));
    was_half_done = was_half_done || (!files.empty() && !files.contains("members.csv"));
  }
  EXPECT_TRUE(was_half_done) << "no kill has hit a run with something to go on from";
  ASSERT_EQ(smoothfem({"study", "all.prm", "--out", "killed", "--quiet"}).exit_code, 0);
  expect_same_tables("unbroken", "killed");
}

TEST_F(Collections, MembersWhoseProcessWasKilledAreOpenAgain) {
  write_good_meshes(2);
  write_study(
      "set methods = once\nsubsection method once\n set command = test -f {folder}/again || "
      "{ touch {folder}/again; kill -9 $PPID; }; cp {in} {out}\nend\n");
  const Outcome killed = smoothfem({"study", "all.prm", "--out", "out"});
  EXPECT_EQ(killed.exit_code, 0) << killed.err;
  EXPECT_THAT(killed.err, ::testing::HasSubstr("1 member is complete, 0 have failed"));
  EXPECT_THAT(killed.err, ::testing::HasSubstr("1 did not reach their end"));
  const auto open = table("out/members.csv").select({{"status", "meshed"}});
  ASSERT_EQ(open.size(), 1u);
  EXPECT_THAT(open[0].at("reason"), ::testing::HasSubstr("was killed"));
  const Outcome again = smoothfem({"study", "all.prm", "--out", "out"});
  EXPECT_THAT(again.err, ::testing::HasSubstr("2 members are complete, 0 have failed"));
  EXPECT_THAT(smoothfem({"study", "all.prm", "--out", "out"}).err,
              ::testing::HasSubstr("nothing to do"));
}

TEST_F(Collections, MembersMayHaveATimeLimit) {
  write_good_meshes(1);
  write_study(
      "set time limit = 2\nset methods = slow\nsubsection method slow\n"
      " set command = sleep 1000; : {in} {out}\nend\n");
  const Outcome outcome = smoothfem({"study", "all.prm", "--out", "out", "--quiet"});
  EXPECT_EQ(outcome.exit_code, 2) << "no member is complete";
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("no member of out is complete"));
  EXPECT_EQ(table("out/members.csv").rows.at(0).at("reason"),
            "it has taken longer than the time limit of 2 s");
}

TEST_F(Collections, ChangedMeshFilesAreSeen) {
  write_good_meshes(2);
  file_with("meshes/rubbish.vtk", "not a mesh\n");
  write_study();
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"study", "all.prm", "--out", "out"});
    return smoothfem(more);
  };
  EXPECT_THAT(run({}).err, ::testing::HasSubstr("2 members are complete, 1 has failed"));
  EXPECT_THAT(run({}).err, ::testing::HasSubstr("nothing to do"));
  EXPECT_THAT(run({"--retry-failed"}).err,
              ::testing::HasSubstr("2 members are complete, 1 has failed"));
  write_mesh(file("meshes/rubbish.vtk"), shaken_grid(3, 0.2));
  EXPECT_THAT(run({}).err, ::testing::HasSubstr("3 members are complete, 0 have failed"));
  write_mesh(file("meshes/good1.vtu"), shaken_grid(3, 0.2));
  const Outcome changed = run({});
  EXPECT_EQ(changed.exit_code, 0);
  EXPECT_THAT(changed.err, ::testing::HasSubstr("Kept: 2 of 3 members."));
  EXPECT_EQ(CsvTable(content_of(file("out/members.csv")))
                .select({{"file", "good1.vtu"}})
                .at(0)
                .at("n_nodes"),
            "16");
}

TEST_F(Collections, FilesMayHaveAnyNames) {
  write_study("set collection = meshes/*, meshes/...vtk\n");
  fs::create_directories(file("meshes"));
  for (const std::string name :
       {"e'.vtk", "e+.vtk", "e-.vtk", "...vtk", "bin\xff\xfe.vtk", "a\nb.vtk"})
    write_mesh(file("meshes") / name, shaken_grid(3, 0.2));
  fs::create_symlink("loop.vtk", file("meshes/loop.vtk"));
  std::vector<std::string> names;
  for (const auto& member : read_collection(file("all.prm")).members) names.push_back(member.name);
  EXPECT_EQ(names, (std::vector<std::string>{"-.", "a-b", "bin--", "meshes-e-.vtk",
                                             "meshes-e-.vtk.2", "meshes-e-.vtk.3"}));
  const Outcome outcome = smoothfem({"study", "all.prm", "--out", "out"});
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("6 members are complete, 0 have failed"));
  EXPECT_EQ(table("out/members.csv").select({{"file", "bin\xEF\xBF\xBD\xEF\xBF\xBD.vtk"}}).size(),
            1u);
}

TEST_F(Collections, MethodsThatKnowTheSolutionHaveMeshesOfTheirOwnForEach) {
  write_good_meshes(1);
  const auto qualities = [&](const std::string& solutions, const std::string& of) {
    write_study("set solutions = " + solutions +
                "\nset methods = laplace, weights\nsubsection method weights\n"
                " set type = indicator-weighted\n set weights.solves = 3\nend\n" +
                (solutions.find("bump") == std::string::npos
                     ? ""
                     : "subsection solution bump\n"
                       " set u = exp(-9*((X - 0.3)^2 + (Y - 0.4)^2))\nend\n"));
    EXPECT_EQ(smoothfem({"study", "all.prm", "--out", solutions, "--quiet"}).exit_code, 0);
    std::map<std::string, std::string> q_mean;
    for (const auto& row : table(solutions + "/summary.csv").select({{"solution", of}}))
      q_mean[row.at("method")] = row.at("q_mean");
    return q_mean;
  };
  const auto sine = qualities("sine, bump", "sine"), bump = qualities("sine, bump", "bump");
  EXPECT_EQ(sine.at("laplace"), bump.at("laplace"));
  EXPECT_NE(sine.at("weights"), bump.at("weights"));
  EXPECT_EQ(sine, qualities("sine", "sine"));
  EXPECT_EQ(bump, qualities("bump", "bump"));
}

TEST_F(Collections, MethodsThatKnowTheSolutionTakeVolumeMeshes) {
  file_with("cubes.prm",
            "set kind = collection\nset domains = cube: 5\nset methods = laplace, weights\n"
            "set degrees = 2\nset timing runs = 1\nset solutions = sine\n"
            "subsection method weights\n set type = indicator-weighted\n"
            " set weights.solves = 2\nend\n"
            "subsection finite elements\n set condition number = none\nend\n");
  const Outcome outcome = smoothfem({"study", "cubes.prm", "--out", "out", "--quiet"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(table("out/members.csv").select({{"status", "complete"}}).size(), 2u);
}

TEST_F(Collections, MayIncludeOthers) {
  file_with("base.prm",
            "set kind = collection\nset domains = square: 9\nset elements = triangles\n"
            "set sizes = 1, 2\nset methods = laplace\nset degrees = 1\n");
  EXPECT_EQ(read_collection(file("base.prm")).members.size(), 2u);
  file_with("own.prm", "include base.prm\nset sizes = 1\n");
  EXPECT_EQ(read_collection(file("own.prm")).members.size(), 1u);
  file_with("wrong.prm", "include base.prm\nset sizes = 1\nset degree = 2\n");
  const Outcome outcome = smoothfem({"study", "wrong.prm", "--dry-run"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("wrong.prm:3: "));
}

TEST_F(Collections, RefusesBadCollections) {
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
  refused("set distortionsx = 0.5\n", "distortionsx");
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

/// The process that the test below starts.
TEST(TaskServer, DISABLED_Answers) {
  const std::string socket = own_command().back();
  const int socket_number = std::stoi(socket.substr(socket.find('=') + 1));
  answer_tasks(socket_number, [&](const std::string& task) {
    if (task == "crash") std::raise(SIGKILL);
    if (task == "end") std::_Exit(3);
    if (task == "throw") throw std::runtime_error("two\nlines");
    if (task == "lock") throw FolderTaken("taken");
    if (task == "garbage") {
      EXPECT_EQ(::write(socket_number, "garbage", 7), 7);
    }
    if (task == "fork") (void)::fork();
    if (task == "sleep") ::sleep(1000);
    return task + " done";
  });
}

const std::vector<std::string> task_server{own_command()[0], "--gtest_also_run_disabled_tests",
                                           "--gtest_filter=TaskServer.*", "--gtest_brief=1",
                                           "--gtest_print_time=0"};

TaskAnswer answer_of(TaskProcess& process, const std::string& task) {
  process.give(task);
  std::optional<TaskAnswer> answer;
  while (!(answer = process.answer())) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return *answer;
}

std::string text_of(const TaskAnswer& answer) {
  return answer.outcome + "|" + answer.failure;
}

TEST(TaskProcess, ACrashingTaskDoesNotAffectOthers) {
  TaskProcess process(task_server);
  const auto answer_to = [&](const std::string& task) { return text_of(answer_of(process, task)); };
  EXPECT_EQ(answer_to("first"), "first done|");
  EXPECT_EQ(answer_to("crash"), "|the process that worked on it was killed: Killed");
  EXPECT_EQ(answer_to("second"), "second done|");
  EXPECT_EQ(answer_to("throw"), "|two lines");
  EXPECT_EQ(answer_to("end"), "|the process that worked on it has ended with exit code 3");
  EXPECT_EQ(answer_to("third"), "third done|");
  EXPECT_EQ(process.answer(), std::nullopt);
}

TEST(TaskProcess, OnlyAnswersAreTakenForAnswers) {
  TaskProcess process(task_server);
  EXPECT_THAT(answer_of(process, "garbage").failure, ::testing::HasSubstr("file descriptor"));
  EXPECT_EQ(text_of(answer_of(process, "fork")), "fork done|");
  EXPECT_EQ(text_of(answer_of(process, "next")), "next done|");
}

TEST(TaskProcess, KnowsWhichFailuresAreNotThoseOfTheTask) {
  TaskProcess process(task_server);
  EXPECT_TRUE(answer_of(process, "crash").may_succeed_later);
  EXPECT_TRUE(answer_of(process, "lock").may_succeed_later);
  EXPECT_FALSE(answer_of(process, "throw").may_succeed_later);
  EXPECT_FALSE(answer_of(process, "end").may_succeed_later);
}

TEST(TaskProcess, EndsTasksThatTakeTooLong) {
  TaskProcess process(task_server, 0.5);
  const TaskAnswer answer = answer_of(process, "sleep");
  EXPECT_EQ(answer.failure, "it has taken longer than the time limit of 0.5 s");
  EXPECT_FALSE(answer.may_succeed_later);
}

TEST_F(Collections, OnRanksOfMpirunTheyAreTheSame) {
  write_good_meshes(5);
  write_study("set solutions = sine, linear\n");
  file_with("meshes/rubbish.vtk", "not a mesh\n");
  ASSERT_EQ(smoothfem({"study", "all.prm", "--out", "alone", "--quiet"}).exit_code, 0);
  const Outcome outcome = smoothfem_on_ranks(3, {"study", "all.prm", "--out", "ranks"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("10 members are complete, 2 have failed"));
  EXPECT_THAT(content_of(file("ranks/provenance.json")),
              ::testing::HasSubstr("\"finite_element_threads\": 3"));
  expect_same_tables("alone", "ranks");
  // Errors that only the root would find end all ranks.
  for (const std::string wrong : {"--shard=4/3", "--mesh-dir=meshes"}) {
    const Outcome refused = smoothfem_on_ranks(2, {"study", "all.prm", "--out", "other", wrong});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
  }
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
