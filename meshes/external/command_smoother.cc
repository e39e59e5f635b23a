// SPDX-License-Identifier: GPL-3.0-or-later
#include <fstream>
#include <numeric>

#include "meshes/external/command_line.h"
#include "meshes/external/external_program.h"
#include "meshes/external/returned_mesh.h"
#include "meshes/external/text_vtk.h"
#include "meshes/io/mesh_file.h"
#include "meshes/io/text/medit_text.h"
#include "smoothing/base/interruption.h"
#include "smoothing/base/text.h"
#include "smoothing/loop/catalogue.h"

namespace smoothfem {
namespace {

namespace fs = std::filesystem;

/// Two formats have the extension .mesh; for planar meshes `mesh` is polygonal text.
std::string extension(const std::string& format) {
  return format == "medit" ? "mesh" : format;
}

/// The user's parameters of a command.
struct CommandParameters {
  ExternalProgram program;
  std::string format = "vtk", out_format, series, time_pattern, startup_command;
  int max_iterations = 64, every = 0, repeat = 1, second_order = 0;
  double time_unit = 1.0;

  Parameters list() {
    return {
        {"command",
         "program with its options, run by /bin/sh in an empty folder; {in} and {out} are its "
         "mesh files (without {out} it changes {in}), {iterations} is the number of iterations, "
         "{folder} is the base of relative file names",
         &program.command},
        {"format",
         "format of {in}: vtk (legacy, as text), vtu, msh (text), mesh, inp, or medit: in.mesh "
         "with "
         "the edges or faces of the boundary, also for planar meshes",
         &format},
        {"out_format", "format of {out}; empty: that of {in}", &out_format},
        {"second_order",
         "true: the program gets and moves the midside nodes of meshes of second order, too; the "
         "format must hold them (not vtk). false: it gets the corners, and midside nodes follow",
         Choice{&second_order, {"false", "true"}}},
        {"files", "files to copy next to {in}, separated by commas", &program.files},
        {"max_iterations", "largest value of {iterations}, used in the last run", &max_iterations,
         1.0, 1e6},
        {"every", "step of {iterations} between separate runs; 0: runs with 1, 2, 4, 8, ...",
         &every, 0.0, 1e6},
        {"series",
         "files of one run that writes a mesh after each iteration: a name with {iteration}, "
         "which begins with 1",
         &series},
        {"repeat",
         "without {iterations} and a series: number of runs, each on the mesh of the previous "
         "run",
         &repeat, 1.0, 1e6},
        {"time_pattern",
         "regular expression whose first group is the time that the program prints; empty: "
         "wall-clock time less that of a run of startup_command",
         &time_pattern},
        {"time_unit", "seconds in a unit of that time: 0.001 for milliseconds", &time_unit, 0.0,
         1e6, true},
        {"startup_command",
         "the same program without work; empty: with {iterations} = 0, if the command has it",
         &startup_command},
        {"version_command", "command that prints the program's version, for the provenance",
         &program.version_command},
        {"timeout", "largest time of a run, in seconds", &program.timeout, 0.0, 1e9, true}};
  }

  bool counts_iterations() const { return has_placeholder(program.command, "iterations"); }
  std::string file_out_format() const { return out_format.empty() ? format : out_format; }
  std::string in() const { return "in." + extension(format); }
  std::string out() const {
    return has_placeholder(program.command, "out") ? "out." + extension(file_out_format()) : in();
  }

  /// Throws InputError if they do not define a command that can be run.
  void check() const {
    const std::string needs = ", such as 'set command = mmg3d_O3 -noinsert -noswap {in} {out}'";
    const std::string& command = program.command;
    if (command.empty()) throw InputError("the method command needs a command" + needs);
    if (!has_placeholder(command, "in"))
      throw InputError("the command '" + command + "' has no {in} for the file of its mesh" +
                       needs);
    for (const auto& given : {format, file_out_format()})
      require_mesh_path("mesh." + extension(given));
    if (second_order != 0 && format == "vtk")
      throw InputError(
          "second_order = true needs a format with cells of second order for {in}: 'vtk' has "
          "linear cells only; write 'set format = msh' or 'set format = vtu'");
    const bool counts = counts_iterations();
    if (!series.empty() && !has_placeholder(series, "iteration"))
      throw InputError("the series '" + series +
                       "' has no {iteration}, which is 1, 2, 3, ... in names such as "
                       "step_{iteration}.vtk");
    if (repeat > 1 && (counts || !series.empty()))
      throw InputError("a command with {iterations} or a series is not repeated; leave repeat out");
    if (!time_pattern.empty()) (void)times();
  }

  LinePattern times() const { return {"time_pattern", time_pattern}; }
};

/// An external program as a smoother. It reads the mesh from a file and writes a file in which only
/// the nodes' positions differ. A record has one of three sources: a run of the program on the
/// initial mesh with so many iterations; a file of one run's series; or (repeat) a run on the
/// previous record.
template <int dim>
class CommandSmoother final : public Smoother<dim> {
 public:
  std::string_view name() const override { return "command"; }
  Parameters parameters() override { return p_.list(); }
  void check_parameters() const override { p_.check(); }
  void use_folders(const SmootherFolders& folders) override { p_.program.folders = folders; }

  SmootherTraits traits() const override {
    return {.quality_use = QualityUse::none,
            .result = ResultMesh::last,
            .needs_valid_mesh = false,
            .needs_node_order = true,  // files have the user's order
            .moves_midside_nodes = p_.second_order != 0};
  }

  StoppingRule stopping() const override {
    return {.criterion = StoppingRule::Criterion::step_says_so, .max_iterations = n_records()};
  }

  SmootherOrigin origin() override { return p_.program.origin(); }

  void initialize(const SmoothingState<dim>& state) override {
    p_.check();
    initial_.emplace(state.mesh);
    n_done_ = 0;
    seconds_ = wall_seconds_ = 0.0;
    series_.reset();
    startup_seconds_.reset();
  }

  StepReport step(SmoothingState<dim>& state) override {
    if (!p_.series.empty()) return next_of_series(state);
    const bool counts = p_.counts_iterations();
    const int n = counts ? count_after(n_done_) : n_done_ + 1;
    const ScratchFolder scratch;
    const Run made = run_program(counts ? *initial_ : state.mesh, counts ? n : 1, scratch.path());
    const auto points =
        returned_coordinates<dim>(p_.program.left_file(scratch.path(), p_.out()), *initial_);
    const double time = method_seconds(made, last_time(made.output));
    // Runs with a number of iterations start from the initial mesh, other runs from the previous
    // record.
    seconds_ = counts ? time : seconds_ + time;
    wall_seconds_ = counts ? made.wall_seconds : wall_seconds_ + made.wall_seconds;
    return report(state, points, n, false);
  }

 private:
  using Run = CommandEnd;

  StepReport report(SmoothingState<dim>& state, const std::vector<Point<dim>>& points, int n,
                    bool is_last) {
    state.mesh.set_coordinates(points);
    const int n_before = std::exchange(n_done_, n);
    return {.n_counted = static_cast<std::size_t>(n - n_before),
            .converged = is_last,
            .stage_seconds = seconds_,
            .wall_seconds = wall_seconds_};
  }

  int count_after(int n) const {
    const int next = p_.every > 0 ? n + p_.every : std::max(1, 2 * n);
    return std::min(next, p_.max_iterations);
  }

  /// The number of records of a series is known after its run, and may be smaller.
  int n_records() const {
    if (!p_.series.empty()) return p_.max_iterations;
    if (!p_.counts_iterations()) return p_.repeat;
    int n_records = 0;
    for (int n = 0; n < p_.max_iterations; n = count_after(n)) ++n_records;
    return n_records;
  }

  /// Reads the next file of the series. All of them come from one run, at the first step.
  StepReport next_of_series(SmoothingState<dim>& state) {
    if (!series_) {
      series_.emplace();
      series_run_ = run_program(*initial_, p_.max_iterations, series_->path());
      n_in_series_ = 0;
      while (n_in_series_ < p_.max_iterations && is_plain_file(series_file(n_in_series_ + 1)))
        ++n_in_series_;
      if (n_in_series_ == 0)
        throw SmootherFailure("it left no file " + series_file(1).filename().string() +
                              p_.program.last_output_text());
      series_times_ = p_.time_pattern.empty()
                          ? std::vector<double>()
                          : times_in(series_run_.output, p_.times(), p_.time_unit);
    }
    const int n = n_done_ + 1;
    const auto points = returned_coordinates<dim>(series_file(n), *initial_);
    // One time for each iteration, or one for all, of which each gets an equal share.
    const auto i = static_cast<std::size_t>(n - 1);
    if (series_times_.size() >= static_cast<std::size_t>(n_in_series_))
      seconds_ = series_times_[i];
    else
      seconds_ = method_seconds(series_run_, last_time(series_run_.output)) * n / n_in_series_;
    wall_seconds_ = series_run_.wall_seconds;
    return report(state, points, n, n == n_in_series_);
  }

  fs::path series_file(int iteration) const {
    return series_->path() / with_placeholder(p_.series, "iteration", std::to_string(iteration));
  }

  /// Returns the time that the program prints, or the run's time less its start and its files.
  double method_seconds(const Run& made, std::optional<double> printed) {
    if (printed) return *printed;
    if (!startup_seconds_) startup_seconds_ = measured_startup();
    return std::max(0.0, made.wall_seconds - *startup_seconds_);
  }

  /// Returns the last time that the program has printed, in seconds.
  std::optional<double> last_time(const std::string& output) const {
    if (p_.time_pattern.empty()) return std::nullopt;
    const auto times = times_in(output, p_.times(), p_.time_unit);
    if (times.empty())
      throw SmootherFailure("it printed nothing that the time_pattern '" + p_.time_pattern +
                            "' matches" + p_.program.last_output_text());
    return times.back();
  }

  double measured_startup() {
    if (p_.startup_command.empty() && !p_.counts_iterations()) return 0.0;
    const ScratchFolder scratch;
    write_input_files(*initial_, scratch.path());
    const Run idle = p_.program.run(
        filled_in(p_.startup_command.empty() ? p_.program.command : p_.startup_command, 0),
        scratch.path());
    return idle.exit_code == 0 && idle.signal == 0 ? idle.wall_seconds : 0.0;
  }

  /// Runs the program. Throws SmootherFailure if it fails.
  Run run_program(const Mesh<dim>& mesh, int n_iterations, const fs::path& folder) {
    write_input_files(mesh, folder);
    (void)p_.program.path();
    return p_.program.run_to_success(filled_in(p_.program.command, n_iterations), folder);
  }

  /// Writes the mesh and copies the accompanying files. The mesh is text if the format has a text
  /// form, which most programs read.
  void write_input_files(const Mesh<dim>& mesh, const fs::path& folder) const {
    if (p_.format == "vtk")
      write_text_vtk(folder / p_.in(), mesh);
    else if (p_.format == "medit")
      write_medit_with_boundary(folder / p_.in(), mesh);
    else
      write_mesh(folder / p_.in(), mesh, {}, {.msh_version = MshVersion::v4_1, .binary = false});
    p_.program.copy_files(folder);
  }

  std::string filled_in(const std::string& command, int n_iterations) const {
    return p_.program.filled_in(
        command,
        {{"in", p_.in()}, {"out", p_.out()}, {"iterations", std::to_string(n_iterations)}});
  }

  CommandParameters p_;
  std::optional<Mesh<dim>> initial_;
  std::optional<double> startup_seconds_;
  std::optional<ScratchFolder> series_;
  Run series_run_;
  std::vector<double> series_times_;
  int n_done_ = 0, n_in_series_ = 0;
  double seconds_ = 0.0, wall_seconds_ = 0.0;
};

const RegisteredMethod registered(
    {.name = "command",
     .title = "Command",
     .description = "smooths by an external program, which reads the mesh "
                    "from a file and writes it with moved nodes",
     .source = "the external program",
     .needs_parameters = true},
    single_stage<CommandSmoother>());

}  // namespace
}  // namespace smoothfem
