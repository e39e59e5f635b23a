// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/definition/find_study.h"

#include <algorithm>

#include "smoothing/base/data_folder.h"
#include "smoothing/base/find_named.h"
#include "studies/framework/definition/study_file.h"

namespace smoothfem {

namespace fs = std::filesystem;

fs::path built_in_studies() {
  return data_folder() / "studies" / "catalogue";
}

std::vector<fs::path> study_files(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".prm") files.push_back(entry.path());
  std::sort(files.begin(), files.end(),
            [](const fs::path& a, const fs::path& b) { return a.filename() < b.filename(); });
  return files;
}

namespace {

/// Returns the study file that a path probably means, in the same folder; empty if there is none.
fs::path nearest_study_file(const fs::path& path) {
  std::vector<std::string> names;
  std::error_code not_there;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  for (const auto& entry : fs::directory_iterator(folder, not_there))
    if (entry.path().extension() == ".prm") names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  const std::string name = path.filename();
  const bool only_lacks_ending =
      std::find(names.begin(), names.end(), name + ".prm") != names.end();
  const std::string nearest = only_lacks_ending ? name + ".prm" : nearest_name(name, names);
  return nearest.empty() ? fs::path() : path.parent_path() / nearest;
}

}  // namespace

fs::path find_study(const std::string& path_or_name) {
  const fs::path path = path_or_name;
  if (fs::exists(path) && (fs::is_regular_file(path) || path.has_parent_path())) return path;
  const bool is_path = path.has_parent_path() || path.extension() == ".prm";
  const auto built_in = study_files(built_in_studies());
  if (!is_path)
    for (const auto& file : built_in)
      if (file.stem() == path_or_name) return file;
  if (const fs::path nearest = nearest_study_file(path); !nearest.empty() && !fs::exists(path))
    throw InputError("there is no study " + path_or_name + "; did you mean " + nearest.string() +
                     "?");
  if (is_path) return path;
  return find_named("study", path_or_name, built_in,
                    [](const fs::path& file) { return file.stem().string(); });
}

bool is_built_in(const fs::path& file) {
  for (const fs::path& own : study_files(built_in_studies()))
    if (own.filename() == file.filename()) return read_study_text(own) == read_study_text(file);
  return false;
}

}  // namespace smoothfem
