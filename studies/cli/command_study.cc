// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

#include "fem/ranks/mpi_session.h"
#include "smoothing/base/input_error.h"
#include "smoothing/base/interruption.h"
#include "studies/cli/commands.h"
#include "studies/cli/watched_files.h"
#include "studies/framework/definition/find_study.h"
#include "studies/framework/definition/published_sets.h"
#include "studies/framework/definition/study.h"
#include "studies/framework/run/peak_memory.h"
#include "studies/kinds/study_kinds.h"

namespace smoothfem {

namespace {

struct StudyArguments {
  std::string study;
  std::string scale;
  bool quick = false;
  bool list = false;
  bool print_plan = false;
  int plan_to = -1;  ///< file descriptor; -1: none
  bool published = false;
  std::string published_set;  ///< empty: the meshes that the study names
  bool no_figures = false;
  bool verbose = false;
  bool watch = false;
  StudyOptions options;
};

ReadyStudy read(const StudyArguments& arguments) {
  return read_any_study(find_study(arguments.study), arguments.quick ? "quick" : arguments.scale);
}

/// Warns about keys that the study file sets twice. A process of the run leaves that to its parent.
void warn_about_repetitions(const StudyArguments& arguments) {
  if (!arguments.options.ranks.is_root() || arguments.options.task_socket >= 0) return;
  for (const auto& sentence : StudyText(find_study(arguments.study)).repetitions())
    std::fprintf(stderr, "smoothfem: warning: %s\n", sentence.c_str());
}

void run(StudyArguments& arguments, std::optional<MpiSession>& mpi) {
  StudyOptions& options = arguments.options;
  if (options.ranks.is_root()) {
    notice_signals();
    options.interrupted = &interruption();
  } else {  // the root ends the run
    std::signal(SIGINT, SIG_IGN);
    std::signal(SIGTERM, SIG_IGN);
  }
  // Looking at a stranger's study file must not run it.
  const std::optional<OnlyLook> only_look =
      options.dry_run ? std::optional<OnlyLook>(std::in_place) : std::nullopt;
  const ReadyStudy study = read(arguments);
  warn_about_repetitions(arguments);
  if (study.needs_mpi && !mpi) {
    mpi.emplace();
    options.ranks = Ranks(MPI_COMM_WORLD);
  }
  if (!options.shard.empty() && !study.has_shards)
    throw InputError("--shard is for collections, but the study " + study.header.name +
                     " is of another kind; leave it out");
  if (options.retry_failed && !study.has_shards)
    throw InputError("--retry-failed is for collections, but the study " + study.header.name +
                     " is of another kind; leave it out");
  if (arguments.published && options.mesh_dir.empty() && study.published.empty())
    throw InputError("--published has no effect with --dry-run; leave one of them out");
  if (options.out.empty()) options.out = std::filesystem::path("results") / study.header.name;
  study.run(options);
}

void run_on_all_ranks(StudyArguments& arguments) {
  std::optional<MpiSession> mpi;
  if (started_by_mpirun()) {
    mpi.emplace();
    arguments.options.ranks = Ranks(MPI_COMM_WORLD);
  }
  try {
    run(arguments, mpi);
  } catch (const InputError&) {
    if (arguments.options.ranks.is_root()) throw;
    mpi.reset();
    std::exit(2);  // all ranks find the same fault; the root reports it
  }
}

/// The launcher's work for a study.
struct LauncherPlan {
  /// One item a line. "ranks N": number of processes that is fastest on this machine. "out FOLDER":
  /// results folder. "draw OPTION": option for drawing. "fetch NAME": published meshes are wanted,
  /// those of the study or, with "set NAME", of these sets.
  /// "watch FILE": a file or folder that the study depends on, with --watch.
  std::string text;
  bool comes_first = false;  ///< before the program's own work
};

/// Plans the launcher's work. The plan is empty if there is none. Runs no code that the study
/// names.
LauncherPlan launcher_plan(const StudyArguments& arguments) {
  if (arguments.list || arguments.options.dry_run) return {};
  // More processes speed up a study if they share the finite elements of volume meshes.
  unsigned n_ranks = 1;
  std::string name = std::filesystem::path(arguments.study).stem();
  const OnlyLook only_look;
  LauncherPlan plan;
  const auto add = [&](const std::string& what, const std::string& value) {
    plan.text += what + " " + value + "\n";
  };
  const auto watch = [&](const std::vector<std::filesystem::path>& files) {
    for (const auto& file : files) add("watch", file.string());
  };
  const std::filesystem::path file = find_study(arguments.study);
  if (arguments.watch) watch(files_of(StudyText(file)));
  try {
    const ReadyStudy study = read(arguments);
    name = study.header.name;
    if (arguments.published)
      for (const auto& set : study.published) add("set", set);
    if (arguments.watch) watch(named_files(study.header.parameters, file.parent_path()));
    if (study.benefits_from_mpi) n_ranks = std::max(1U, std::thread::hardware_concurrency());
  } catch (const InputError&) {
    // Published meshes may be missing yet, and a study that is watched is being edited; the run
    // itself reports the fault.
    if (!arguments.published && !arguments.watch) throw;
  }
  const auto& out = arguments.options.out;
  add("ranks", std::to_string(n_ranks));
  add("out", (out.empty() ? std::filesystem::path("results") / name : out).string());
  if (arguments.options.quiet) add("draw", "--quiet");
  if (arguments.verbose) add("draw", "--verbose");
  if (arguments.no_figures) add("draw", "--no-figures");
  if (arguments.published) add("fetch", arguments.study);
  plan.comes_first = n_ranks > 1 || arguments.published;
  return plan;
}

/// Writes the plan to the file descriptor that the launcher has opened for it.
void send_plan(const LauncherPlan& plan, int descriptor) {
  if (::write(descriptor, plan.text.data(), plan.text.size()) !=
      static_cast<ssize_t>(plan.text.size()))
    throw InputError("the plan of the study cannot be written; start the command smoothfem");
  ::close(descriptor);
}

void list_studies() {
  for (const auto& file : study_files(built_in_studies())) {
    const StudySummary study = read_summary(file);
    std::printf("%-16s %s\n", study.name.c_str(), study.title.c_str());
    if (!study.note.empty()) std::printf("%-16s   %s\n", "", study.note.c_str());
  }
}

}  // namespace

void smoothfem_add_study_command(CLI::App& app) {
  return_freed_memory();
  auto arguments = std::make_shared<StudyArguments>();
  auto* command = add_subcommand(app, "study");
  auto* name = command->add_option("study", arguments->study,
                                   "study file (.prm), or name of a built-in study");
  command->add_flag("--list", arguments->list, "only list the built-in studies")->excludes(name);
  command->add_option("--out", arguments->options.out,
                      "folder for the results (default: results/NAME)");
  command->add_option("--mesh-dir", arguments->options.mesh_dir,
                      "folder with the published meshes that the study names");
  auto* published = command
                        ->add_option("--published", arguments->published_set,
                                     "fetch the published meshes that the study names, once, and "
                                     "run on them; for the study collection: those of a set (see "
                                     "--list)")
                        ->expected(0, 1)
                        ->type_name("[SET]");
  command
      ->add_option("--threads", arguments->options.n_threads,
                   "threads for the finite elements of planar meshes (default: all cores)")
      ->check(CLI::Range(1, 1024));
  command
      ->add_option("--smoothing-threads", arguments->options.smoothing_threads,
                   "threads for smoothing (default: 1, for times that compare with the thesis)")
      ->check(CLI::Range(1, 1024));
  command->add_option(
      "--scale", arguments->scale,
      "one of the study's scales, for example quick or paper: other mesh sizes and records");
  command->add_flag("--quick", arguments->quick, "the same as --scale quick");
  auto* shard = command->add_option(
      "--shard", arguments->options.shard,
      "run only part K of N of a collection, for example 3/10; 'smoothfem merge' merges the "
      "results");
  command->add_flag("--retime", arguments->options.retime,
                    "smooth all meshes again, to measure all times in one session; keep the finite "
                    "element results");
  command
      ->add_option("--keep", arguments->options.keep,
                   "number of earlier results to keep below the folder earlier/ (default: 1)")
      ->check(CLI::Range(0, 1000));
  command->add_flag(
      "--force", arguments->options.force,
      "compute everything anew; keep the folder of an earlier run under another name");
  command->add_flag("--retry-failed", arguments->options.retry_failed,
                    "try the members of a collection again that have failed");
  command->add_flag("--quiet", arguments->options.quiet, "no progress, no results on the screen");
  command->add_flag("--verbose", arguments->verbose, "print all tables and the paths of all files");
  // For the launcher, which draws. This program never draws.
  command->add_flag("--no-figures", arguments->no_figures, "make tables, but draw nothing")
      ->envname("SMOOTHFEM_NO_FIGURES");
  // For the launcher, too.
  command->add_flag("--watch", arguments->watch,
                    "run again when the study, a smoother's file or a mesh changes, until Ctrl-C; "
                    "report.html in an open browser shows the new results by itself");
  command->add_flag("--dry-run", arguments->options.dry_run,
                    "only show what would run, the estimated time, memory and disk space; no code "
                    "that the study names is run");
  command->add_flag("--print-plan", arguments->print_plan)->group("");  // for the launcher
  command->add_option("--plan-to", arguments->plan_to)->group("");      // for the launcher
  command->add_option("--task-socket", arguments->options.task_socket)->group("");  // not shown
  add_plugin_option(*command);
  add_examples(*command, {"smoothfem study gear --quick", "smoothfem study my.prm --dry-run",
                          "smoothfem study gear --plugin ./libmine.so"});
  command->callback([arguments, shard, published] {
    arguments->published = published->count() > 0;
    // "--published gear" is a study after the option.
    if (arguments->study.empty()) std::swap(arguments->study, arguments->published_set);
    if (shard->count() > 0 && arguments->options.shard.empty())
      throw InputError(
          "--shard is empty; write the part and the number of parts, for example 1/10, or leave it "
          "out");
    if (arguments->list) return arguments->print_plan ? void() : list_studies();
    if (arguments->quick && !arguments->scale.empty() && arguments->scale != "quick")
      throw InputError("--quick asks for the scale quick, --scale for " + arguments->scale +
                       "; give one of them");
    if (arguments->study.empty())
      throw InputError("which study? 'smoothfem study --list' shows the available ones");
    if (!arguments->published_set.empty())
      arguments->study = study_on_published_set(arguments->study, arguments->published_set);
    if (arguments->print_plan)
      return void(std::fputs(launcher_plan(*arguments).text.c_str(), stdout));
    if (arguments->watch)
      throw InputError(
          "--watch is for the command smoothfem by itself and a study that runs: leave out mpirun, "
          "--dry-run and --print-plan");
    // The processes of a collection have the same command line.
    if (arguments->plan_to >= 0 && arguments->options.task_socket < 0) {
      const LauncherPlan plan = launcher_plan(*arguments);
      send_plan(plan, arguments->plan_to);
      if (plan.comes_first) return;
    }
    // The launcher fetches, and passes on the folder.
    if (arguments->published && arguments->options.mesh_dir.empty() && !arguments->options.dry_run)
      throw InputError(
          "--published is for the command smoothfem by itself, not under mpirun; run it "
          "once without, or name the folder of the meshes by --mesh-dir");
    run_on_all_ranks(*arguments);
  });
}

}  // namespace smoothfem
