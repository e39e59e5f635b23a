// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "smoothfem_versions.h"
#include "smoothing/base/find_named.h"
#include "smoothing/base/interruption.h"
#include "smoothing/simd/registers.h"
#include "studies/cli/commands.h"
#include "studies/cli/piece_commands.h"

namespace smoothfem {

namespace {

constexpr int exit_bad_input = 2;

/// Returns the parser's message, with the nearest name if a command or an option is not known.
std::string parse_message(const CLI::App& app, const CLI::ParseError& error, int argc,
                          char** argv) {
  std::vector<std::string> names;
  const auto given = app.get_subcommands();
  if (given.empty() && argc > 1 && argv[1][0] != '-') {
    for (const auto* command : app.get_subcommands([](const CLI::App*) { return true; }))
      names.push_back(command->get_name());
    return no_such_name("command", argv[1], names);
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr || given.empty())
    return std::string(error.what()) + "; 'smoothfem --help' shows the commands";
  for (const auto* option : given.front()->get_options())
    if (!option->get_group().empty())  // options without a group are for programs
      for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  const auto extras = given.front()->remaining();
  const std::string wanted =
      extras.empty() ? "" : extras.front().substr(0, extras.front().find('='));
  const std::string command = "'smoothfem " + given.front()->get_name();
  if (!wanted.starts_with("-"))
    return command + "' takes no further word, but got '" + wanted + "'; " + command +
           " --help' shows what it takes";
  return no_such_name("option", wanted, names) + " of " + command + "'";
}

int run(int argc, char** argv) {
  CLI::App app("smoothfem: what mesh smoothing does to a finite element solution", "smoothfem");
  app.set_version_flag("--version", "smoothfem " SMOOTHFEM_VERSION " (vector registers: " +
                                        std::string(registers()) + ")");
  app.require_subcommand(1);
  // Processes of mpirun share the work of these commands; other commands are for one process.
  constexpr std::array shared{"study", "smooth", "quality", "check", "generate", "convert"};
  if (argc > 1 && !is_first_process() &&
      std::find(shared.begin(), shared.end(), std::string_view(argv[1])) == shared.end())
    return 0;
  app.option_defaults()->always_capture_default();
  for (const Command& command : commands())
    add_command(app, command, argc > 1 && argv[1] == command.name);
  add_complete_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const ExitCode& exit) {
    return exit.code;
  } catch (const CLI::ParseError& error) {
    if (is_first_process())
      std::fprintf(stderr, "smoothfem: %s\n", parse_message(app, error, argc, argv).c_str());
    return exit_bad_input;
  }
  return 0;
}

/// Throws InputError if standard output cannot be written, for example on a full disk.
void flush_stdout_or_throw() {
  if (std::fflush(stdout) != 0)
    throw InputError(std::string("cannot write to standard output: ") + std::strerror(errno));
  if (std::ferror(stdout) != 0)  // earlier; the reason has been forgotten
    throw InputError("cannot write to standard output: its disk may be full");
}

}  // namespace
}  // namespace smoothfem

int main(int argc, char** argv) {
  try {
    const int exit_code = smoothfem::run(argc, argv);
    smoothfem::flush_stdout_or_throw();
    return exit_code;
  } catch (const smoothfem::InputError& error) {
    // Processes of mpirun have the same words.
    if (smoothfem::is_first_process()) std::fprintf(stderr, "smoothfem: %s\n", error.what());
    return smoothfem::exit_bad_input;
  } catch (const smoothfem::Interrupted&) {
    return 130;  // as of a process that SIGINT has ended
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr,
                 "smoothfem: there is not enough memory for this mesh; use a smaller one\n");
    return 1;
  } catch (const std::filesystem::filesystem_error& error) {
    std::fprintf(stderr, "smoothfem: %s: %s; check the path and who may use it\n",
                 error.path1().c_str(), error.code().message().c_str());
    return smoothfem::exit_bad_input;
  } catch (const std::system_error& error) {  // for example, no more threads
    std::fprintf(stderr,
                 "smoothfem: the system cannot give what the program needs (%s); close other "
                 "programs, take fewer --threads, or raise the limits that 'ulimit -a' shows\n",
                 error.code().message().c_str());
    return smoothfem::exit_bad_input;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "smoothfem: internal error: %s\n", error.what());
    return 1;
  }
}
