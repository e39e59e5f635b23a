// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <regex>

#include "smoothing/base/data_folder.h"
#include "smoothing/base/input_error.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/preset.h"
#include "studies/cli/commands.h"

namespace smoothfem {

namespace {

/// True if a study file names sets of published meshes, which have to be fetched.
bool needs_published_meshes(const std::filesystem::path& file) {
  static const std::regex sets(R"(\s*set\s+published\s*=.*)");
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);)
    if (std::regex_match(line, sets)) return true;
  return false;
}

/// fetched: with the studies that need sets of published meshes.
std::vector<std::string> study_names(bool fetched) {
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(data_folder() / "studies" / "catalogue"))
    if (entry.path().extension() == ".prm" && (fetched || !needs_published_meshes(entry.path())))
      names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> names_of(const std::string& what) {
  std::vector<std::string> names;
  if (what == "commands")
    for (const Command& command : commands()) names.push_back(command.name);
  else if (what == "methods")
    for (const auto& info : method_catalogue(true)) names.push_back(info.name);
  else if (what == "presets")
    for (const auto& preset : presets()) names.push_back(preset.name);
  else if (what == "studies")
    names = study_names(true);
  else if (what == "all")
    names = study_names(false);  // that 'study all' runs
  else
    throw InputError("complete takes commands, methods, presets, studies or all, not '" + what +
                     "'");
  return names;
}

}  // namespace

/// Adds the command that completion of command lines calls for names. It has to be quick, and the
/// help does not list it.
void add_complete_command(CLI::App& app) {
  auto what = std::make_shared<std::string>();
  auto* command = app.add_subcommand("complete", "")->group("");
  command->add_option("what", *what)->required();
  command->callback([what] {
    for (const std::string& name : names_of(*what)) std::printf("%s\n", name.c_str());
  });
}

}  // namespace smoothfem
