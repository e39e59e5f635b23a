// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>
#include <nlohmann/json.hpp>

#include "smoothing/second_order/raise_order.h"
#include "studies/tests/command_line.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// Studies and commands whose smoother is another program. Here that program is smoothfem, so that
/// the correct result is known.
class CommandMethod : public CommandLine {
 protected:
  CommandMethod() { write_mesh(file("grid.vtu"), shaken_grid(6, 0.2)); }

  /// Runs a study of eight iterations of Laplace smoothing and methods with these keys: label to
  /// keys.
  Outcome run_study(const std::map<std::string, std::string>& methods,
                    const std::vector<std::string>& options = {}) {
    std::string labels, subsections;
    for (const auto& [label, keys] : methods) {
      labels += ", " + label;
      subsections += "subsection method " + label + "\n" + keys + "end\n";
    }
    file_with("my.prm",
              "set meshes = m\nset methods = laplace" + labels +
                  "\nset degrees = 1\n"
                  "set timing runs = 2\nsubsection mesh m\n set file = grid.vtu\nend\n"
                  "subsection method laplace\n set tolerance = 0\n set max_iterations = 8\nend\n" +
                  subsections);
    std::vector<std::string> words{"study", "my.prm", "--out", "out", "--quiet"};
    words.insert(words.end(), options.begin(), options.end());
    return smoothfem(words);
  }
  Outcome run_study(const std::string& keys, const std::vector<std::string>& options = {}) {
    return run_study(std::map<std::string, std::string>{{"other", keys}}, options);
  }

  CsvTable table(const std::string& name) const {
    return CsvTable(content_of(file("out/" + name)));
  }

  /// Returns the status of each method's row, in a study that has run to its end.
  std::map<std::string, std::string> statuses_of(
      const std::map<std::string, std::string>& methods) {
    const Outcome outcome = run_study(methods);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const CsvTable summary = table("summary.csv");
    EXPECT_EQ(summary.select({{"method", "laplace"}}).at(0).at("status"), "ok");
    std::map<std::string, std::string> statuses;
    for (const auto& [label, keys] : methods) {
      const auto rows = summary.select({{"method", label}});
      EXPECT_EQ(rows.size(), 1u);
      EXPECT_EQ(rows.at(0).at("e_l2") == "", rows.at(0).at("status") != "ok");
      statuses[label] = rows.at(0).at("status");
    }
    return statuses;
  }
  std::string status_of(const std::string& keys) { return statuses_of({{"other", keys}})["other"]; }

  static std::string laplace(const std::string& iterations, const std::string& in = "{in}",
                             const std::string& out = "{out}") {
    return std::string("'") + SMOOTHFEM_PROGRAM + "' smooth " + in +
           " -m laplace --set tolerance=0 --set max_iterations=" + iterations + " -o " + out;
  }

  /// Expects that every row of the method has the numbers of Laplace's row of the same iteration.
  void expect_laplace(const std::vector<std::string>& iterations) const {
    const auto rows = table("iterations.csv").select({{"method", "other"}});
    std::vector<std::string> found;
    for (const auto& row : rows) {
      found.push_back(row.at("iteration"));
      const auto known = table("iterations.csv")
                             .select({{"method", "laplace"}, {"iteration", row.at("iteration")}});
      ASSERT_EQ(known.size(), 1u);
      for (const std::string column : {"q_min", "q_mean", "condition_number", "e_l2", "l2_error"})
        EXPECT_EQ(row.at(column), known[0].at(column)) << row.at("iteration") << " " << column;
    }
    EXPECT_EQ(found, iterations);
  }
};

TEST_F(CommandMethod, IsRunAnewForMoreAndMoreIterations) {
  EXPECT_EQ(status_of(" set command = " + laplace("{iterations}") + "\n set max_iterations = 8\n"),
            "ok");
  expect_laplace({"0", "1", "2", "4", "8"});
}

TEST_F(CommandMethod, TakesEveryKthIterationAndOtherFormats) {
  EXPECT_EQ(status_of(" set command = " + laplace("{iterations}") +
                      "\n set max_iterations = 7\n set every = 3\n set format = msh\n"
                      " set out_format = mesh\n"),
            "ok");
  expect_laplace({"0", "3", "6", "7"});
}

TEST_F(CommandMethod, MeditIsWrittenForPlanarMeshesToo) {
  EXPECT_EQ(status_of(" set command = grep -q Edges {in} && " + laplace("1") +
                      "\n set format = medit\n set out_format = vtk\n"),
            "ok");
  expect_laplace({"0", "1"});
}

/// The program moves all nodes. Run in this process, its method gives the same mesh.
TEST_F(CommandMethod, GetsAndMovesMidsideNodesIfAsked) {
  PlanarMesh mesh = with_midside_nodes(read_planar(file("grid.vtu")).mesh);
  const NodeIndex on_boundary = mesh.topology().midside_nodes(0)[0];
  mesh.coordinates()[on_boundary] += Point<2>(0.02, 0.1);
  write_mesh(file("curved.vtu"), mesh);
  const std::string same = " -m curved-optimization --set max_iterations=1 --allow-worse -o {out}";
  const auto smooth = [&](const std::string& out, std::vector<std::string> words) {
    words.insert(words.begin(), {"smooth", "curved.vtu", "-o", out, "--allow-worse", "-m"});
    return smoothfem(words);
  };
  EXPECT_EQ(smooth("here.vtu", {"curved-optimization", "--set", "max_iterations=1"}).exit_code, 0);
  const std::string command =
      "command=" + (std::string("'") + SMOOTHFEM_PROGRAM + "' smooth {in}") + same;
  std::vector<std::string> words{"command", "--set", command, "--set", "second_order=true"};
  const Outcome refused = smooth("there.vtu", words);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("write 'set format = msh' or 'set format = vtu'"));
  words.insert(words.end(), {"--set", "format=msh"});
  const Outcome outcome = smooth("there.vtu", words);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(read_planar(file("there.vtu")).mesh.copied_coordinates(),
            read_planar(file("here.vtu")).mesh.copied_coordinates());
  EXPECT_NE(read_planar(file("there.vtu")).mesh.copied_coordinates(), mesh.copied_coordinates());
}

TEST_F(CommandMethod, RepeatsOnItsOwnResult) {
  EXPECT_EQ(status_of(" set command = " + laplace("1") + "\n set repeat = 3\n"), "ok");
  expect_laplace({"0", "1", "2", "3"});
}

TEST_F(CommandMethod, TakesASeriesOfFilesOfOneRun) {
  const std::string script = "for i in 1 2 3; do " + laplace("$i", "$1", "step$i.vtk") +
                             " && echo \"time $i: 0.$i s\"; done\n";
  file_with("steps.sh", script);
  EXPECT_EQ(status_of(" set command = sh steps.sh {in}\n set files = steps.sh\n"
                      " set series = step{iteration}.vtk\n set time_pattern = time .: ([0-9.]+)\n"
                      " set time_unit = 0.001\n"),
            "ok");
  expect_laplace({"0", "1", "2", "3"});
  const auto rows = table("iterations.csv").select({{"method", "other"}});
  EXPECT_NEAR(std::stod(rows.at(2).at("smoothing_seconds")), 2e-4, 1e-12);
  EXPECT_GT(std::stod(rows.at(2).at("wall_seconds")), 1e-3);
  EXPECT_EQ(rows.at(0).at("wall_seconds"), "");
}

TEST_F(CommandMethod, TimeIsThatOfTheClockWithoutTheStart) {
  file_with("slow.sh", "sleep 0.2; [ $3 = 0 ] || sleep 0.3; cp $1 $2\n");
  EXPECT_EQ(status_of(" set command = sh slow.sh {in} {out} {iterations}\n set files = slow.sh\n"
                      " set max_iterations = 1\n"),
            "ok");
  const auto row = table("summary.csv").select({{"method", "other"}}).at(0);
  const double seconds = std::stod(row.at("smoothing_seconds"));
  const double wall = std::stod(row.at("wall_seconds"));
  EXPECT_GE(wall, 0.5);
  EXPECT_LE(seconds, wall - 0.2 + 1e-9);
  EXPECT_GT(seconds, 0.0);
}

TEST_F(CommandMethod, ReadsTheInputMeshIfTheCommandChangesIt) {
  EXPECT_EQ(status_of(" set command = " + laplace("2", "{in}", "{in}") + "\n"), "ok");
  const auto rows = table("iterations.csv");
  EXPECT_EQ(rows.select({{"method", "other"}, {"iteration", "1"}}).at(0).at("q_mean"),
            rows.select({{"method", "laplace"}, {"iteration", "2"}}).at(0).at("q_mean"));
}

TEST_F(CommandMethod, KeepsItsLogAndNamesItsOrigin) {
  file_with("mine.sh", "echo I was here; cp $1 $2\n");
  EXPECT_EQ(status_of(" set command = sh mine.sh {in} {out}\n set files = mine.sh\n"
                      " set version_command = echo Mine 1.2\n"),
            "ok");
  EXPECT_THAT(
      content_of(file("out/logs/m_other.log")),
      AllOf(HasSubstr("$ sh mine.sh in.vtk out.vtk\nI was here\n"), HasSubstr("exit code 0")));
  const auto json = nlohmann::json::parse(content_of(file("out/provenance.json")));
  const auto& method = json.at("methods").at(1);
  EXPECT_EQ(method.at("version"), "Mine 1.2");
  EXPECT_EQ(method.at("files").at(1).at("name"), "mine.sh");
  EXPECT_EQ(method.at("files").at(1).at("sha256").get<std::string>().size(), 64u);
  // Results of another program are made anew; those of other methods are kept.
  file_with("mine.sh", "echo I am new; cp $1 $2\n");
  const Outcome again = smoothfem({"study", "my.prm", "--out", "out"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.err, AllOf(HasSubstr("content of method other, mine.sh has changed"),
                               HasSubstr("Kept: 1 of 2 smoothing runs")));
  EXPECT_THAT(content_of(file("out/logs/m_other.log")), HasSubstr("I am new\n"));
}

TEST_F(CommandMethod, FailuresAreRowsWithTheReason) {
  const std::pair<std::string, std::string> commands[] = {
      {"no-such-program {in} {out}", "there is no program 'no-such-program'"},
      {"./mine {in} {out}", "there is no program './mine'"},
      {"sh -c 'echo disk broken; exit 7' {in}",
       "it ended with exit code 7; the last it printed: 'disk broken'"},
      {"sh -c 'kill -9 $$' {in}", "it was killed by signal 9"},
      {"sh -c 'sleep 100' {in}\n set timeout = 0.3", "it ran for more than 0.3 s and was ended"},
      {"true {in} {out}", "it left no file out.vtk"},
      {"cp /dev/null {out} {in}", "it ended with exit code 1"},
      {"sh -c ': > out.vtk' {in} {out}", "its mesh cannot be read: out.vtk"},
      {"cp {in} {out}\n set time_pattern = ([0-9]+) ms",
       "it printed nothing that the time_pattern"},
      {"sh -c 'echo time: nan; cp in.vtk out.vtk' {in} {out}\n set time_pattern = time: (.*)",
       "it printed the time 'nan', which is not a number of at least 0"},
      {"sh -c 'mkfifo out.vtk' {in} {out}", "it left no file out.vtk"},
      {"cp {in} {out}\n set series = s{iteration}.vtk", "it left no file s1.vtk"},
      {"cp {in} {out}\n set files = none.sh", "there is no file 'none.sh'"},
      {"cp {in} {out}\n set files = mine.sh, b/mine.sh",
       "two of its files have the name 'mine.sh'"}};
  file_with("mine.sh", "");
  fs::create_directories(file("b"));
  file_with("b/mine.sh", "");
  std::map<std::string, std::string> methods;
  for (const auto& [command, reason] : commands)
    methods["m" + std::to_string(methods.size())] = " set command = " + command + "\n";
  const auto statuses = statuses_of(methods);
  for (std::size_t k = 0; k < std::size(commands); ++k)
    EXPECT_THAT(statuses.at("m" + std::to_string(k)), StartsWith("failed: " + commands[k].second))
        << commands[k].first;
}

/// Programs that make forbidden changes, written in awk for planar polygonal text.
TEST_F(CommandMethod, CheatsAreRowsWithTheReason) {
  file_with("cheat.awk",
            "/^nodes/ { node = $2; print; next }\n"
            "/^polygons/ && kind == \"drop\" { print \"polygons \" $2 - 1; dropped = 0; poly = 1; "
            "next }\n"
            "poly == 1 && dropped == 0 { dropped = 1; next }\n"
            "node > 0 { node--; n++\n"
            "  if (kind == \"fixed\" && n == 1) { print $1 + 0.1, $2; next }\n"
            "  if (kind == \"nan\" && n == 9) { print \"nan\", $2; next } }\n"
            "/^polygon_mean/ && kind == \"drop\" { exit }\n"
            "{ print }\n");
  const std::pair<std::string, std::string> cheats[] = {
      {"fixed", "it has moved 1 fixed node, by up to 0.1"},
      {"drop", "its mesh has 35 cells in place of 36"},
      {"nan", "its mesh cannot be read: out.mesh:"}};
  std::map<std::string, std::string> methods;
  for (const auto& [kind, reason] : cheats)
    methods[kind] = " set command = awk -v kind=" + kind +
                    " -f cheat.awk {in} > {out}\n set files = cheat.awk\n set format = mesh\n";
  const auto statuses = statuses_of(methods);
  for (const auto& [kind, reason] : cheats)
    EXPECT_THAT(statuses.at(kind), StartsWith("failed: " + reason)) << kind;
}

TEST_F(CommandMethod, RecordsBeforeAFailureStay) {
  file_with("mine.sh", "[ $3 -lt 4 ] || { echo enough; exit 1; }; cp $1 $2\n");
  EXPECT_THAT(status_of(" set command = sh mine.sh {in} {out} {iterations}\n"
                        " set files = mine.sh\n"),
              StartsWith("failed: it ended with exit code 1; the last it printed: 'enough'"));
  EXPECT_EQ(table("iterations.csv").select({{"method", "other"}}).size(), 3u);
}

TEST_F(CommandMethod, WrongKeysAreRefusedBeforeAnythingRuns) {
  const std::pair<std::string, std::string> keys[] = {
      {" set command = cp a b\n", "has no {in} for the file of its mesh"},
      {" set command = cp {in} {out}\n set format = doc\n", "mesh.doc"},
      {" set command = cp {in} {out}\n set series = step.vtk\n", "has no {iteration}"},
      {" set command = cp {in} {out}\n set time_pattern = time\n", "has no group"},
      {" set command = cp {in} {out}\n set time_pattern = (\n", "is not a regular expression"},
      {" set command = cp {in} {out} {iterations}\n set repeat = 2\n", "is not repeated"},
      {" set type = command\n", "needs a command"}};
  for (const auto& [text, reason] : keys) {
    const Outcome outcome = run_study(text);
    EXPECT_EQ(outcome.exit_code, 2) << text;
    EXPECT_THAT(outcome.err, HasSubstr(reason)) << text;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(file("out"))) << text;
  }
}

TEST_F(CommandMethod, SmoothsAFile) {
  const Outcome outcome = smoothfem({"smooth", "grid.vtu", "-m", "command", "--set",
                                     "command=" + laplace("2"), "-o", "out.mesh"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(smoothfem({"smooth", "grid.vtu", "-m", "laplace", "--set", "tolerance=0", "--set",
                       "max_iterations=2", "-o", "same.mesh"})
                .exit_code,
            0);
  EXPECT_EQ(content_of(file("out.mesh")), content_of(file("same.mesh")));
  const Outcome failed = smoothfem(
      {"smooth", "grid.vtu", "-m", "command", "--set", "command=false {in}", "-o", "none.mesh"});
  EXPECT_EQ(failed.exit_code, 2);
  EXPECT_EQ(failed.err, "smoothfem: the method command failed: it ended with exit code 1\n");
  EXPECT_FALSE(fs::exists(file("none.mesh")));
}

TEST_F(CommandMethod, TypeAndListKnowIt) {
  EXPECT_THAT(smoothfem({"list"}).out, HasSubstr("\n  command: Command\n"));
  const Outcome all = smoothfem({"study", "gear", "--quick", "--dry-run"});
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_THAT(all.out, testing::Not(HasSubstr("command")));
}

}  // namespace
}  // namespace smoothfem
