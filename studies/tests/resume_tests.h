// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <csignal>
#include <random>
#include <thread>

#include "smoothing/tests/volume_meshes.h"
#include "studies/framework/results/folder_lock.h"
#include "studies/tests/command_line.h"

namespace smoothfem {

namespace fs = std::filesystem;

/// Tests that kill studies and run them on several processes, by the command line.
class Resume : public CommandLine {
 protected:
  /// degrees: of the finite elements. n: number of cubes along an edge of the boxes.
  explicit Resume(const std::string& degrees = "1, 2", std::uint32_t n = 4) {
    write_mesh(file("grid.mesh"), shaken_grid(12, 0.2));
    file_with("planar.prm",
              "set meshes = grid\nset methods = laplace, getme\nset timing runs = 1\n"
              "subsection mesh grid\n set file = grid.mesh\nend\n"
              "subsection method getme\n set sequential.max_cycles = 40\nend\n");
    write_mesh(file("tet.vtu"), test::box_mesh(n, n, n, test::BoxCells::tetrahedra));
    write_mesh(file("hex.vtu"), test::box_mesh(n, n, n, test::BoxCells::hexahedra));
    file_with("volume.prm",
              "set dimension = 3\nset meshes = tet, hex\nset methods = smart-laplace, getme\n"
              "set timing runs = 1\nset record stages every = sequential: 4\nset degrees = " +
                  degrees +
                  "\n"
                  "subsection solution\n set name = volume\nend\n"
                  "subsection finite elements\n set condition number = verified\n"
                  " set multigrid cg = results\nend\n"
                  "subsection mesh tet\n set file = tet.vtu\n set distort to = 0.5\nend\n"
                  "subsection mesh hex\n set file = hex.vtu\n set distort to = 0.6\nend\n");
    file_with(
        "moving.prm",
        "set dimension = 3\nset meshes = tet, hex\nset timing runs = 1\nset degrees = " + degrees +
            "\n"
            "set methods = descent, residual, both\nset solutions = volume, ramp\n"
            "subsection solution ramp\n set u = exp(3*x)*y\n set diffusivity = 1 + z\nend\n"
            "subsection mesh tet\n set file = tet.vtu\n set distort to = 0.5\nend\n"
            "subsection mesh hex\n set file = hex.vtu\n set distort to = 0.6\nend\n"
            "subsection method descent\n set type = energy-descent\n"
            " set smooth for = ramp, volume\n set descent.solves = 6\nend\n"
            "subsection method residual\n set type = indicator-weighted\n"
            " set weights.indicator = residual\n set weights.solves = 3\nend\n"
            "subsection method both\n set type = indicator-weighted-descent\n"
            " set smooth for = ramp\n set weights.solves = 3\n set descent.solves = 3\nend\n");
  }

  /// Writes a study of the solvers that take several ranks.
  void write_solver_study(const std::string& name) const {
    file_with(name,
              "set dimension = 3\nset meshes = tet, hex\nset methods = smart-laplace\n"
              "set timing runs = 1\nset record every = 100\nset degrees = 1\n"
              "set solvers = reference, plate\n"
              "subsection solution\n set u = sin(2*x)*y + z^2\nend\n"
              "subsection mesh tet\n set file = tet.vtu\n set distort to = 0.5\nend\n"
              "subsection mesh hex\n set file = hex.vtu\n set distort to = 0.6\nend\n"
              "subsection solver reference\n set type = deal.II\n set cg_tolerance = 1e-12\nend\n"
              "subsection solver plate\n set type = elasticity\n set cg_tolerance = 1e-12\n"
              " set u = x*y ; y*z ; sin(x)\nend\n");
  }

  /// Words of a command; with several ranks they begin with `mpirun -np n_ranks`.
  std::vector<std::string> command(const std::string& study, const std::string& out,
                                   int n_ranks = 1) const {
    std::vector<std::string> words;
    if (n_ranks > 1) words = mpirun_on(n_ranks);
    for (const std::string& word :
         {std::string(SMOOTHFEM_PROGRAM), std::string("study"), file(study).string(),
          std::string("--out"), file(out).string(), std::string("--quiet")})
      words.push_back(word);
    return words;
  }

  /// Starts a process, and returns its number.
  static pid_t start(const std::vector<std::string>& words) {
    const pid_t child = ::fork();
    if (child != 0) return child;
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
    std::vector<char*> arguments;
    for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execvp(arguments[0], arguments.data());
    ::_exit(127);
  }

  static int run(const std::vector<std::string>& words) {
    int status = 0;
    ::waitpid(start(words), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  /// True if the run in a folder has finished some rows, but not all of its work.
  bool is_half_done(const std::string& out) const {
    const fs::path provenance = file(out) / "provenance.json", rows = file(out) / "iterations.csv";
    if (!fs::exists(provenance) || !fs::exists(rows)) return false;
    const std::string text = content_of(rows);
    return content_of(provenance).find(R"("status": "running")") != std::string::npos &&
           std::count(text.begin(), text.end(), '\n') > 1;
  }

  static void kill_and_wait(pid_t child) {
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
  }

  /// Kills the study as soon as it is half done.
  void kill_half_done(const std::string& study, const std::string& out) {
    using Clock = std::chrono::steady_clock;
    const pid_t child = start(command(study, out));
    const auto too_late = Clock::now() + std::chrono::minutes(2);
    while (!is_half_done(out) && Clock::now() < too_late)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    kill_and_wait(child);
  }

  /// Kills the study once half done and n times at a random moment, and then lets it end.
  void kill_and_go_on(const std::string& study, const std::string& out, int n, double longest) {
    kill_half_done(study, out);
    ASSERT_TRUE(is_half_done(out)) << "no kill has hit a run with something to go on from";
    std::mt19937 random(11);
    for (int i = 0; i < n; ++i) {
      const pid_t child = start(command(study, out));
      const double seconds = longest * (random() / 4294967296.0);
      std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
      kill_and_wait(child);
    }
    EXPECT_EQ(run(command(study, out)), 0);
  }

  /// Expects the same text, or numbers that differ only within the solvers' tolerances. Counts of
  /// CG depend on rounding, on distorted meshes by about 2 %. Multigrid aggregates on each rank
  /// separately, so its iterations may differ.
  static void expect_near(const std::string& column, const std::string& a, const std::string& b) {
    ASSERT_EQ(a.empty(), b.empty()) << column;
    if (a == b || column.ends_with("amg_cg_iterations") || column.ends_with("_seconds")) return;
    const double x = std::stod(a), y = std::stod(b);
    const double tolerance = column.ends_with("iterations")   ? std::max(2.0, 0.025 * x)
                             : column == "condition_residual" ? 1e-6
                                                              : 1e-6 * std::abs(x);
    EXPECT_NEAR(x, y, tolerance) << column;
  }

  /// Runs a study on one process and on some ranks, and compares the rows.
  void expect_same_rows_on_ranks(const std::string& study, std::initializer_list<int> ranks) const {
    ASSERT_EQ(run(command(study + ".prm", study)), 0);
    for (const int n : ranks) {
      const std::string out = study + std::to_string(n);
      ASSERT_EQ(run(command(study + ".prm", out, n)), 0);
      for (const std::string name : {"iterations.csv", "summary.csv"}) {
        const auto one = rows_without_times(file(study) / name);
        const auto several = rows_without_times(file(out) / name);
        ASSERT_EQ(one.size(), several.size());
        for (std::size_t i = 0; i < one.size(); ++i)
          for (const auto& [column, value] : one[i])
            expect_near(column, value, several[i].at(column));
      }
    }
  }
};

}  // namespace smoothfem
