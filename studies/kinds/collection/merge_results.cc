// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/collection/merge_results.h"

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "meshes/io/atomic_file.h"
#include "smoothing/base/input_error.h"
#include "studies/framework/results/provenance.h"
#include "studies/kinds/collection/member_row.h"

namespace smoothfem {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json read_json(const fs::path& path) {
  std::ifstream stream(path);
  return Json::parse(stream);
}

/// Throws InputError if the folders are not results of one collection.
void require_one_collection(const std::vector<fs::path>& folders) {
  const EarlierRun first = read_provenance(folders.front() / "provenance.json");
  for (const auto& folder : folders) {
    const EarlierRun run = read_provenance(folder / "provenance.json");
    const auto kind = run.settings.find("kind");
    if (kind == run.settings.end() || kind->second != "collection")
      throw InputError(folder.string() +
                       " has no results of a collection; name folders that 'smoothfem study' has "
                       "written for one");
    for (const auto& [key, value] : run.settings)
      if (!first.settings.contains(key) || first.settings.at(key) != value)
        throw InputError("the results in " + folder.string() + " and in " +
                         folders.front().string() + " are not of one study: they differ in " + key +
                         "; merge those of the same study file and scale");
  }
}

/// Returns the first folder's provenance with the sessions of all.
Json merged_provenance(const std::vector<fs::path>& folders) {
  Json merged = read_json(folders.front() / "provenance.json");
  std::map<std::string, double> seconds;
  merged["sessions"] = Json::array();
  for (const auto& folder : folders) {
    const Json provenance = read_json(folder / "provenance.json");
    if (provenance.at("status") != "complete") merged["status"] = "interrupted";
    for (const auto& session : provenance.at("sessions")) merged["sessions"].push_back(session);
    for (const auto& [phase, value] : provenance.at("seconds").items())
      seconds[phase] += value.get<double>();
  }
  merged["seconds"] = seconds;
  merged["written"] = now_utc();
  return merged;
}

/// Returns the folder that each member is taken from.
std::map<std::string, fs::path> folders_of_members(const std::vector<fs::path>& folders) {
  std::map<std::string, fs::path> chosen;
  std::map<std::string, bool> is_complete;
  for (const auto& folder : folders)
    for (const auto& row : read_rows(folder)) {
      const std::string& name = row.at("member");
      const bool complete = row.at("status") == member_complete;
      if (chosen.contains(name) && (is_complete[name] || !complete)) continue;
      chosen[name] = folder;
      is_complete[name] = complete;
    }
  return chosen;
}

void write_merged(const std::vector<fs::path>& folders, const fs::path& out) {
  fs::create_directories(out / "members");
  for (const auto& [name, folder] : folders_of_members(folders))
    fs::copy(member_folder(folder, name), member_folder(out, name), fs::copy_options::recursive);
  write_collected_tables(out, read_rows(out));
  write_atomically(out / "provenance.json", merged_provenance(folders).dump(2) + "\n");
}

}  // namespace

void merge_results(const std::vector<fs::path>& folders, const fs::path& out) {
  if (fs::exists(out))
    throw InputError(out.string() + " is there already; name a folder that is not");
  require_one_collection(folders);
  fs::path unfinished = out;
  if (!unfinished.has_filename()) unfinished = unfinished.parent_path();
  unfinished += ".unfinished";
  try {
    fs::remove_all(unfinished);
    write_merged(folders, unfinished);
    fs::rename(unfinished, out);
  } catch (const fs::filesystem_error& error) {
    fs::remove_all(unfinished);
    throw InputError("cannot write " + out.string() + ": " + error.code().message());
  } catch (...) {
    fs::remove_all(unfinished);
    throw;
  }
}

}  // namespace smoothfem
