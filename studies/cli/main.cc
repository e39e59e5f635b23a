// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <exception>

#include "smoothfem_versions.h"
#include "smoothing/base/input_error.h"
#include "smoothing/simd/registers.h"
#include "studies/cli/commands.h"
#include "studies/framework/run/peak_memory.h"

namespace smoothfem {

namespace {

constexpr int exit_bad_input = 2;

int run(int argc, char** argv) {
  CLI::App app("smoothfem: what mesh smoothing does to a finite element solution", "smoothfem");
  app.set_version_flag("--version", "smoothfem " SMOOTHFEM_VERSION " (vector registers: " +
                                        std::string(registers()) + ")");
  app.footer("smoothfem plot FOLDER draws the tables and figures of a results folder anew.");
  app.require_subcommand(1);
  app.option_defaults()->always_capture_default();
  add_study_command(app);
  add_smooth_command(app);
  add_quality_command(app);
  add_generate_command(app);
  add_list_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    const bool unknown = argc > 1 && argv[1][0] != '-' && app.get_subcommands().empty();
    const std::string what =
        unknown ? "there is no command '" + std::string(argv[1]) + "'" : error.what();
    std::fprintf(stderr, "smoothfem: %s; 'smoothfem --help' shows the commands\n", what.c_str());
    return exit_bad_input;
  }
  return 0;
}

}  // namespace
}  // namespace smoothfem

int main(int argc, char** argv) {
  smoothfem::return_freed_memory();
  try {
    return smoothfem::run(argc, argv);
  } catch (const smoothfem::InputError& error) {
    std::fprintf(stderr, "smoothfem: %s\n", error.what());
    return smoothfem::exit_bad_input;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr,
                 "smoothfem: there is not enough memory for this mesh; use a smaller one\n");
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "smoothfem: internal error: %s\n", error.what());
    return 1;
  }
}
