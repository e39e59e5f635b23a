// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/definition/published_sets.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "smoothing/base/data_folder.h"
#include "smoothing/base/find_named.h"
#include "studies/framework/definition/find_study.h"

namespace smoothfem {

namespace fs = std::filesystem;

namespace {

fs::path catalogues() {
  return data_folder() / "studies" / "published";
}

}  // namespace

std::vector<std::string> published_sets() {
  std::vector<std::string> names;
  std::error_code not_there;
  for (const auto& entry : fs::directory_iterator(catalogues(), not_there))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

std::map<fs::path, std::string> published_meshes(const std::string& name) {
  (void)find_named("published set", name, published_sets());
  const fs::path file = catalogues() / (name + ".json");
  std::ifstream stream(file);
  std::map<fs::path, std::string> meshes;
  try {
    const auto catalogue = nlohmann::json::parse(stream);
    for (const auto& [path, facts] : catalogue.at("files").items())
      meshes.emplace(fs::path(name) / path, facts.at("family").get<std::string>());
  } catch (const nlohmann::json::exception&) {
    throw InputError(file.string() + " is damaged; install smoothfem again");
  }
  return meshes;
}

std::string study_on_published_set(const std::string& study, const std::string& set) {
  std::vector<std::string> sets = published_sets();
  const auto files = study_files(built_in_studies());
  std::erase_if(sets, [&](const std::string& name) {
    return std::none_of(files.begin(), files.end(), [&](const fs::path& file) {
      return file.stem().string() == study + "-" + name;
    });
  });
  if (sets.empty())
    throw InputError("the study " + study +
                     " has no sets of published meshes to choose from; leave '" + set +
                     "' out after --published");
  return study + "-" + find_named("published set", set, sets);
}

}  // namespace smoothfem
