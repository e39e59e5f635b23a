// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/cli/histogram_figure.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "meshes/io/atomic_file.h"
#include "smoothing/quality/mesh_quality.h"

extern char** environ;

namespace smoothfem {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t n_bins = 40;

std::string python() {
  const char* chosen = std::getenv("SMOOTHFEM_PYTHON");
  return chosen && *chosen ? chosen : SMOOTHFEM_PYTHON;
}

/// A temporary file, empty at first, that is removed at the end of the scope.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& purpose)
      : path_((fs::temp_directory_path() / ("smoothfem-" + purpose + "-XXXXXX")).string()) {
    const int descriptor = ::mkstemp(path_.data());
    if (descriptor < 0)
      throw InputError("no file can be created in " + fs::temp_directory_path().string() +
                       "; set TMPDIR to a folder where this is possible");
    ::close(descriptor);
  }
  ~TemporaryFile() { ::unlink(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Runs `python -m plots.quality_histogram figure`; returns its exit code, 127 if it cannot start.
int run_python(const fs::path& figure, const TemporaryFile& input, const TemporaryFile& errors) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, input.path().c_str(), O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors.path().c_str(), O_WRONLY, 0);
  std::vector<std::string> words = {python(), "-m", "plots.quality_histogram", figure.string()};
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  // The package lies in the source folder; nothing is written there.
  std::vector<std::string> settings = {"PYTHONPATH=" SMOOTHFEM_SOURCE_DIR,
                                       "PYTHONDONTWRITEBYTECODE=1"};
  std::vector<char*> environment;
  for (auto& setting : settings) environment.push_back(setting.data());
  for (char** variable = environ; *variable; ++variable)
    if (!std::string_view(*variable).starts_with("PYTHON")) environment.push_back(*variable);
  environment.push_back(nullptr);
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(),
                                   environment.data());
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (error != 0 || ::waitpid(child, &status, 0) != child) return 127;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

/// Python's exceptions end with the line that says what happened.
std::string last_line(const std::string& path) {
  std::ifstream file(path);
  std::string last;
  for (std::string line; std::getline(file, line);)
    if (!line.empty()) last = line;
  return last;
}

std::string numbers(const std::string& title, const Topology& topology,
                    const std::vector<double>& cell_quality) {
  std::map<std::string, std::vector<double>> by_type;
  for (CellIndex c = 0; c < topology.n_cells(); ++c)
    by_type[std::string(name_of(topology.cell_type(c)))].push_back(cell_quality[c]);
  const MeshQuality quality = mesh_quality(topology, cell_quality);
  nlohmann::ordered_json json = {{"title", title},
                                 {"n_invalid", quality.n_invalid},
                                 {"q_min", quality.q_min},
                                 {"q_mean", quality.q_mean}};
  for (const auto& [type, of_type] : by_type)
    json["histogram"][type] = quality_histogram(of_type, n_bins);
  // Names of files may be no UTF-8.
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

void require_figure_path(const fs::path& path) {
  const std::string extension = path.extension().string();
  if (extension != ".png" && extension != ".pdf" && extension != ".svg")
    throw InputError("the histogram " + path.string() + " must end with .png, .pdf or .svg");
}

void write_histogram_figure(const fs::path& path, const std::string& title,
                            const Topology& topology, const std::vector<double>& cell_quality) {
  require_figure_path(path);
  const TemporaryFile input("numbers"), errors("errors");
  std::ofstream(input.path()) << numbers(title, topology, cell_quality);
  write_atomically(path, [&](const fs::path& temporary) {
    const int code = run_python(temporary, input, errors);
    if (code == 0) return;
    const std::string reason = last_line(errors.path());
    throw InputError("cannot write " + path.string() + ": " +
                     (code == 127 ? "there is no Python at " + python() : reason) +
                     "; set SMOOTHFEM_PYTHON to a python3 with matplotlib");
  });
}

}  // namespace smoothfem
