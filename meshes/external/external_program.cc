// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/external/external_program.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "meshes/external/command_line.h"
#include "smoothing/base/text.h"

namespace smoothfem {

namespace fs = std::filesystem;

fs::path ExternalProgram::path() const {
  const std::string word = first_word(command);
  const auto found =
      find_program(word.find('/') == std::string::npos ? word : in_study_folder(word).string());
  if (found.empty())
    throw SmootherFailure("there is no program '" + word +
                          "'; install it, or give its path, relative to the study file");
  return found;
}

SmootherOrigin ExternalProgram::origin() {
  SmootherOrigin origin;
  origin.files.push_back(path());
  for (const auto& file : given_files()) origin.files.push_back(file);
  if (!version_command.empty()) {
    const ScratchFolder scratch;
    const CommandEnd end = run(version_command, scratch.path());
    std::istringstream lines(end.output);
    std::getline(lines, origin.version);
  }
  return origin;
}

void ExternalProgram::copy_files(const fs::path& folder) const {
  for (const auto& file : given_files()) {
    std::error_code error;
    fs::copy_file(file, folder / file.filename(), error);
    if (error)
      throw InputError("cannot copy " + file.string() + " to " + folder.string() + ": " +
                       error.message() + "; make room there, or check who may write");
  }
}

std::string ExternalProgram::filled_in(const std::string& given,
                                       const std::map<std::string, std::string>& values) const {
  std::string filled = after_first_word(given);
  for (const auto& [name, value] : values) filled = with_placeholder(filled, name, value);
  filled = with_placeholder(filled, "folder",
                            shell_quoted(fs::absolute(folders.given).lexically_normal()));
  const std::string word = first_word(given);
  return (word.find('/') == std::string::npos ? word : shell_quoted(in_study_folder(word))) +
         filled;
}

CommandEnd ExternalProgram::run(const std::string& filled, const fs::path& folder) {
  CommandEnd made = run_command(filled, folder, timeout);
  last_output_ = made.output;
  if (!folders.log.empty()) {
    std::error_code ignored;  // opening the file reports an error
    fs::create_directories(folders.log.parent_path(), ignored);
    std::ofstream log(folders.log, std::ios::app);
    log << "$ " << filled << "\n" << made.output;
    if (!made.output.empty() && made.output.back() != '\n') log << "\n";
    log << "# " << made.wall_seconds << " s, "
        << (made.timed_out     ? "ended because it took too long"
            : made.signal != 0 ? "killed by signal " + std::to_string(made.signal)
                               : "exit code " + std::to_string(made.exit_code))
        << "\n";
    if (!log.flush())
      throw InputError("cannot write " + folders.log.string() +
                       "; make room on its disk, or check who may write there");
  }
  return made;
}

CommandEnd ExternalProgram::run_to_success(const std::string& filled, const fs::path& folder) {
  CommandEnd made = run(filled, folder);
  if (made.timed_out)
    throw SmootherFailure("it ran for more than " + number_text(timeout) +
                          " s and was ended; give it less to do, or a longer timeout");
  if (made.signal != 0)
    throw SmootherFailure("it was killed by signal " + std::to_string(made.signal) +
                          last_output_text());
  if (made.exit_code != 0)
    throw SmootherFailure("it ended with exit code " + std::to_string(made.exit_code) +
                          last_output_text());
  return made;
}

fs::path ExternalProgram::left_file(const fs::path& folder, const std::string& name) const {
  if (!is_plain_file(folder / name))
    throw SmootherFailure("it left no file " + name + last_output_text());
  return folder / name;
}

std::string ExternalProgram::last_output_text() const {
  constexpr std::size_t longest = 200;
  std::string line = last_line(last_output_).substr(0, longest);
  std::erase_if(line, [](char c) { return static_cast<unsigned char>(c) < ' '; });
  return line.empty() ? "" : "; the last it printed: '" + line + "'";
}

std::vector<fs::path> ExternalProgram::given_files() const {
  std::vector<fs::path> all;
  for (const auto& name : split_list(files)) {
    const auto file = in_study_folder(name);
    if (!fs::is_regular_file(file))
      throw SmootherFailure("there is no file '" + file.filename().string() +
                            "' in the folder of the study; the command needs a copy of it");
    for (const auto& other : all)
      if (other.filename() == file.filename())
        throw SmootherFailure("two of its files have the name '" + file.filename().string() +
                              "', which cannot be in one folder; rename one of them");
    all.push_back(file);
  }
  return all;
}

/// Returns a path relative to the folder of the user's study.
fs::path ExternalProgram::in_study_folder(const fs::path& name) const {
  return fs::absolute(name.is_relative() ? folders.given / name : name).lexically_normal();
}

bool is_plain_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

}  // namespace smoothfem
