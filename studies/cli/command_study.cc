#include <atomic>
#include <csignal>
#include <filesystem>
#include <memory>

#include "studies/cli/commands.h"
#include "studies/framework/run_study.h"

namespace smoothfem {

namespace {

struct Arguments {
  std::filesystem::path file;
  StudyOptions options;
};

std::atomic<bool> interrupted{false};

/// A study stops at the next good place; a second Ctrl-C ends the process at once.
void on_interrupt(int signal) {
  interrupted = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void add_study_command(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  auto* command = app.add_subcommand("study", "run a study file: CSV tables and meshes");
  command->add_option("file", arguments->file, "study file (.prm)")->required();
  command->add_option("--out", arguments->options.out,
                      "folder for the results (results/NAME unless given)");
  command->add_option("--mesh-dir", arguments->options.mesh_dir,
                      "folder with the published meshes that the study names");
  command
      ->add_option("--threads", arguments->options.n_threads,
                   "threads for the finite elements (all cores unless given)")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--quick", arguments->options.quick,
                    "the study's quick variant: smaller meshes, every k-th record");
  command->add_flag("--quiet", arguments->options.quiet, "no progress");
  command->callback([arguments] {
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
    arguments->options.interrupted = &interrupted;
    const Study study = read_study(arguments->file, arguments->options.quick);
    if (arguments->options.out.empty())
      arguments->options.out = std::filesystem::path("results") / study.name;
    run_study(study, arguments->options);
  });
}

}  // namespace smoothfem
