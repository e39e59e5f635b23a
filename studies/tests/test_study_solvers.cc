// SPDX-License-Identifier: GPL-3.0-or-later
// Solvers of a study in addition to that of Poisson's equation.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "studies/framework/run/run_study.h"
#include "studies/tests/study_tests.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;

class StudySolvers : public FileTest {
 protected:
  StudySolvers() { write_mesh(file("grid.mesh"), shaken_grid(5, 0.2)); }

  Study study(const std::string& keys, const std::string& name = "mine") const {
    return read_study(file_with(name + ".prm",
                                "set meshes = grid\nset methods = laplace\nset timing runs = 1\n"
                                "set record every = 1\n"
                                "subsection mesh grid\n set file = grid.mesh\nend\n"
                                "subsection solution\n set u = x*y\nend\n" +
                                    keys));
  }

  /// Runs a study, and returns its summary.
  CsvTable summary_of(const Study& study, const std::string& folder = "out") const {
    run_study(study, {.out = file(folder), .mesh_dir = {}, .quiet = true, .n_threads = 1});
    return CsvTable(content_of(file(folder) / "summary.csv"));
  }
  CsvTable summary_of(const std::string& keys) const { return summary_of(study(keys)); }

  /// The subsection of a solver that counts its runs in a file, and prints a number.
  std::string counting(const std::string& number) const {
    return "subsection solver count\n set command = sh -c 'echo >> " + file("runs").string() +
           "; echo number " + number + "' {in}\n set number n = number (.*)\nend\n";
  }
  std::size_t n_runs() const {
    return fs::exists(file("runs")) ? content_of(file("runs")).size() : 0;
  }
};

TEST_F(StudySolvers, FillColumnsOfEveryRow) {
  const CsvTable summary = summary_of(
      "set degrees = 1, 2\nset solvers = poisson, reference, beam, count\n"
      "subsection finite elements\n set cg tolerance = 1e-12\nend\n"
      "subsection solver reference\n set type = deal.II\n set cg_tolerance = 1e-12\n"
      " set points = 8\nend\n"
      "subsection solver beam\n set type = elasticity\n set degrees = 2\n set u = x*y ; x\nend\n" +
      counting("-1.5e3"));
  for (const std::string degree : {"1", "2"})
    for (const std::string method : {"initial", "laplace"}) {
      const auto row = summary.select({{"method", method}, {"degree", degree}}).at(0);
      EXPECT_EQ(row.at("status"), "ok");
      EXPECT_EQ(row.at("count.n"), "-1500");
      EXPECT_NEAR(std::stod(row.at("reference.h1_error")), std::stod(row.at("h1_error")), 1e-10);
      EXPECT_EQ(row.at("beam.h1_error") == "", degree == "1");
    }
  const auto rows = CsvTable(content_of(file("out") / "iterations.csv"))
                        .select({{"method", "laplace"}, {"degree", "2"}});
  ASSERT_GT(rows.size(), 2u);
  for (const auto& row : rows) EXPECT_LT(std::stod(row.at("beam.h1_error")), 1e-6);
  const auto provenance = nlohmann::json::parse(content_of(file("out") / "provenance.json"));
  EXPECT_EQ(provenance.at("solvers").at(1).at("label"), "beam");
  EXPECT_EQ(provenance.at("solvers").at(1).at("numbers").at(0).at("column"), "beam.n_dofs");
}

TEST_F(StudySolvers, WithoutDegreesAreSolvedAtAllRecords) {
  summary_of("set degrees = 1, 2\nset record degrees = 1\nset solvers = poisson, count\n" +
             counting("1"));
  const CsvTable iterations(content_of(file("out") / "iterations.csv"));
  const auto rows = iterations.select({{"method", "laplace"}, {"degree", "1"}});
  EXPECT_GT(rows.size(), iterations.select({{"method", "laplace"}, {"degree", "2"}}).size());
  for (const auto& row : rows) EXPECT_EQ(row.at("count.n"), "1");
}

TEST_F(StudySolvers, NeedNoPoisson) {
  const CsvTable summary = summary_of("set solvers = count\n" + counting("1"));
  const auto rows = summary.select({{"method", "laplace"}});
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].at("degree"), "");
  EXPECT_EQ(rows[0].at("h1_error"), "");
  EXPECT_EQ(rows[0].at("count.n"), "1");
  EXPECT_EQ(rows[0].at("status"), "ok");
}

TEST_F(StudySolvers, AreKeptAndSolvedAnewOnlyIfTheyChange) {
  const std::string keys = "set degrees = 1\nset solvers = poisson, count\n";
  summary_of(keys + counting("1"));
  const std::size_t first = n_runs();
  EXPECT_GT(first, 2u);
  fs::remove(file("out") / "summary.csv");
  summary_of(study(keys + counting("1") + "set metrics = shape\n"));
  EXPECT_EQ(n_runs(), first);
  const CsvTable changed = summary_of(keys + counting("2"));
  EXPECT_EQ(n_runs(), 2 * first);
  EXPECT_EQ(changed.select({{"method", "laplace"}}).at(0).at("count.n"), "2");
}

TEST_F(StudySolvers, NumbersMayComeAsJson) {
  const CsvTable summary = summary_of(
      "set degrees =\nset solvers = json\nsubsection solver json\n"
      " set command = sh -c 'echo {\\\"n\\\": $(grep -c . {in}), \\\"half\\\": 0.5} > {out}' {in}\n"
      " set format = mesh\nend\n");
  const auto row = summary.select({{"method", "initial"}}).at(0);
  EXPECT_EQ(row.at("json.half"), "0.5");
  EXPECT_GT(std::stod(row.at("json.n")), 36.0);
}

TEST_F(StudySolvers, FailuresAreRowsWithTheReason) {
  const auto status_of = [&](const std::string& command) {
    static int n = 0;
    const std::string label = "s" + std::to_string(n++);
    const CsvTable summary =
        summary_of(study("set degrees = 1\nset solvers = poisson, other\nsubsection solver other\n "
                         "set timeout = 5\n set command = " +
                             command + "\nend\n",
                         label),
                   label);
    const auto row = summary.select({{"method", "laplace"}}).at(0);
    EXPECT_NE(row.at("h1_error"), "");
    return row.at("status");
  };
  const std::string number = "\n set number n = n (.*)";
  EXPECT_THAT(status_of("no_such_program {in} {out}"),
              StartsWith("other: failed: there is no program 'no_such_program'"));
  EXPECT_THAT(status_of("sh -c 'echo away; exit 3' {in} {out}"),
              HasSubstr("it ended with exit code 3; the last it printed: 'away'"));
  EXPECT_THAT(status_of("sh -c 'sleep 100' {in} {out}\n set timeout = 0.2"),
              HasSubstr("ran for more than 0.2 s"));
  EXPECT_THAT(status_of("true {in} {out}"), HasSubstr("it left no file out.json"));
  EXPECT_THAT(status_of("sh -c 'echo nonsense > {out}' {in}"), HasSubstr("is no JSON"));
  EXPECT_THAT(status_of("sh -c 'echo {\\\"a b\\\": 1} > {out}' {in}"), HasSubstr("the name 'a b'"));
  EXPECT_THAT(status_of("sh -c 'echo {\\\"a\\\": \\\"x\\\"} > {out}' {in}"),
              HasSubstr("gives a a value that is not a finite number"));
  EXPECT_THAT(status_of("echo nothing {in}" + number), HasSubstr("it printed nothing for"));
  EXPECT_THAT(status_of("echo n inf {in}" + number), HasSubstr("not a finite number"));
}

TEST_F(StudySolvers, GroupsThatTheMeshLacksAreFoundBeforeAnythingIsWritten) {
  for (const std::string key : {"E group=steel = 2", "natural = wall"}) {
    const Study with_key = study(
        "set solvers = a\nsubsection solver a\n set type = elasticity\n"
        " set degrees = 1\n set u = x ; y\n set " +
        key + "\nend\n");
    EXPECT_THAT([&] { summary_of(with_key); },
                ThrowsMessage<InputError>(StartsWith("mesh grid, solver a: elasticity ")));
    EXPECT_FALSE(fs::exists(file("out")));
  }
}

/// Methods that move nodes by a solver's solution.
TEST_F(StudySolvers, MakeMeshes) {
  const std::string keys =
      "set methods = laplace, mine\nset solvers = beam, load\n"
      "subsection solver beam\n set type = elasticity\n set degrees = 1\n"
      " set u = exp(-5*x) ; y\n set nu = NU\nend\n"
      "subsection solver load\n set type = convection-diffusion\n set degrees = 1\n"
      " set velocity = 1 ; 1\nend\n"
      "subsection method mine\n set type = METHOD\n set smooth for = SOLVER\nend\n";
  const auto with = [&](const std::string& method, const std::string& solver,
                        const std::string& nu = "0.3") {
    std::string text = keys;
    for (const auto& [word, value] : {std::pair{"METHOD", method}, {"SOLVER", solver}, {"NU", nu}})
      text.replace(text.find(word), std::string(word).size(), value);
    return text;
  };
  const CsvTable summary = summary_of(with("energy-descent", "beam"));
  const auto error = [&](const CsvTable& table, const std::string& method) {
    return std::stod(table.select({{"method", method}}).at(0).at("beam.energy_error"));
  };
  EXPECT_LT(error(summary, "mine"), 0.95 * error(summary, "laplace"));

  const auto kept_names = [&] {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(file("out") / "kept"))
      if (entry.path().string().find("trajectory") != std::string::npos)
        names.insert(entry.path().filename());
    return names;
  };
  const auto before = kept_names();
  summary_of(with("energy-descent", "beam", "0.4"));
  EXPECT_NE(kept_names(), before);  // smoothed anew for the changed solver

  summary_of(with("indicator-weighted", "load"));
  const auto refuse = [&](const std::string& text, const std::string& message) {
    EXPECT_THAT([&] { study(text); }, ThrowsMessage<InputError>(HasSubstr(message)));
  };
  refuse(with("energy-descent", "load"), "this solver has no energy and gradient");
  refuse(with("indicator-mmpde", "beam"), "directions of the error");
  refuse(with("indicator-getme", "beam, load"), "is smoothed for one solver alone");
  refuse(with("indicator-getme", "girder"), "is not in the list 'solvers'");
  refuse(with("smart-laplace", "beam"), "does not move nodes by a solution");
}

TEST_F(StudySolvers, WrongKeysAreRefused) {
  const auto refused = [&](const std::string& keys, const std::string& why) {
    EXPECT_THAT([&] { (void)study(keys); }, ThrowsMessage<InputError>(HasSubstr(why)));
  };
  const auto section = [](const std::string& keys) {
    return "set solvers = poisson, a\nsubsection solver a\n" + keys + "end\n";
  };
  refused("set solvers = poisson, elastic\n", "there is no solver 'elastic'");
  refused("set solvers = poisson, poisson\n", "named twice");
  refused("set solvers = poisson, a.b\n", "has a '.'");
  refused(section(" set type = elasticity\n"), "needs a displacement u");
  refused(section(" set type = elasticity\n set u = x ; y\n set degrees = 5\n"), "of degree '5'");
  refused(section(" set type = elasticity\n set u = x ; y\n set modulus = 5\n"), "'modulus'");
  refused(section(" set type = elasticity\n set u = x ; y\n set E group=a = -1\n"),
          "E group a = -1");
  refused(section(" set command = run\n"), "has no {in}");
  refused(section(" set command = run {in}\n"), "gives no numbers");
  refused(section(" set command = run {in}\n set number n = (\n"), "is not a regular expression");
  refused(section(" set command = run {in}\n set number 1n = (.*)\n"), "no name of a column");
  refused(section(" set command = run {in} {out}\n set degrees = 1\n"), "has no degrees");
  refused(section(" set command = run {in} {out}\n set format = xyz\n"), "xyz");
}

}  // namespace
}  // namespace smoothfem
