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

fs::path find_study(const std::string& path_or_name) {
  const fs::path path = path_or_name;
  if (fs::is_regular_file(path) || path.has_parent_path() || path.extension() == ".prm")
    return path;
  const auto built_in = study_files(built_in_studies());
  return find_named("study", path_or_name, built_in,
                    [](const fs::path& file) { return file.stem().string(); });
}

bool is_built_in(const fs::path& file) {
  for (const fs::path& own : study_files(built_in_studies()))
    if (own.filename() == file.filename()) return read_study_text(own) == read_study_text(file);
  return false;
}

}  // namespace smoothfem
