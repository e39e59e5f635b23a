// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/collection/merge_results.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "meshes/io/atomic_file.h"
#include "smoothing/base/input_error.h"
#include "studies/framework/results/provenance.h"
#include "studies/kinds/collection/definition/collection.h"
#include "studies/kinds/collection/member_row.h"

namespace smoothfem {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json read_json(const fs::path& path) {
  std::ifstream stream(path);
  return Json::parse(stream);
}

/// Returns the first setting of a run that the other does not have; empty if there is none.
std::string difference(const EarlierRun& run, const EarlierRun& other) {
  for (const auto& [key, value] : run.settings)
    if (!other.settings.contains(key) || other.settings.at(key) != value) return key;
  return "";
}

/// Throws InputError if the folders are not results of one collection with the same mesh files.
void require_one_collection(const std::vector<fs::path>& folders) {
  const EarlierRun first = read_provenance(folders.front() / "provenance.json");
  for (const auto& folder : folders) {
    const EarlierRun run = read_provenance(folder / "provenance.json");
    const auto kind = run.settings.find("kind");
    if (kind == run.settings.end() || kind->second != "collection")
      throw InputError(folder.string() +
                       " has no results of a collection; name folders that 'smoothfem study' has "
                       "written for one");
    std::string key = difference(run, first);
    if (key.empty()) key = difference(first, run);
    if (!key.empty())
      throw InputError("the results in " + folder.string() + " and in " + folders.front().string() +
                       " are not of one study: they differ in " + key +
                       "; merge those of the same study file, mesh files and scale");
  }
}

/// The members that a merged folder lacks.
struct Missing {
  std::vector<std::string> members;  ///< in none of the folders
  std::set<unsigned int> parts;      ///< of the shards that they belong to
  unsigned int n_parts = 0;
  std::vector<std::string> open;  ///< of runs that were not completed
  std::size_t n_all = 0;

  bool empty() const { return members.empty() && open.empty(); }
};

Missing missing_members(const std::vector<fs::path>& folders, const std::vector<MemberRow>& rows) {
  Missing missing;
  std::map<std::string, std::string> meshes;
  for (const auto& folder : folders) {
    const Json provenance = read_json(folder / "provenance.json");
    const Json members = provenance.value("members", Json::object());
    for (const auto& [name, mesh] : members.items()) meshes[name] = mesh.get<std::string>();
    if (const std::string shard = provenance.value("shard", ""); !shard.empty())
      missing.n_parts = Shard::parse(shard).n;
  }
  missing.n_all = std::max(meshes.size(), rows.size());
  for (const auto& row : rows) {
    meshes.erase(row.at("member"));
    if (row.at("status") != member_complete && row.at("status") != member_failed)
      missing.open.push_back(row.at("member"));
  }
  for (const auto& [name, mesh] : meshes) {
    missing.members.push_back(name);
    Member member;
    member.mesh.name = mesh;
    for (unsigned int k = 1; k <= missing.n_parts; ++k)
      if (Shard{k, missing.n_parts}.holds(member)) missing.parts.insert(k);
  }
  return missing;
}

std::string sentence(const Missing& missing, const fs::path& out) {
  std::string text = std::to_string(missing.members.size() + missing.open.size()) + " of " +
                     std::to_string(missing.n_all) + " members are not complete in the folders";
  if (!missing.members.empty()) text += "; none of these has " + some_of(missing.members);
  if (!missing.parts.empty()) {
    std::vector<std::string> parts;
    for (const unsigned int k : missing.parts)
      parts.push_back(std::to_string(k) + "/" + std::to_string(missing.n_parts));
    text += ", which belong to " + some_of(parts);
  }
  return text + "; " + out.string() +
         " has the others: merge again when all parts are complete, or run the study with this "
         "--out to complete it";
}

/// Returns the first folder's provenance with the sessions of all.
Json merged_provenance(const std::vector<fs::path>& folders, bool is_whole) {
  Json merged = read_json(folders.front() / "provenance.json");
  merged.erase("shard");
  if (!is_whole) merged["status"] = "interrupted";
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

/// Returns the members that it lacks.
Missing write_merged(const std::vector<fs::path>& folders, const fs::path& out) {
  fs::create_directories(out / "members");
  for (const auto& [name, folder] : folders_of_members(folders))
    fs::copy(member_folder(folder, name), member_folder(out, name), fs::copy_options::recursive);
  auto rows = read_rows(out);
  const Missing missing = missing_members(folders, rows);
  for (const auto& name : missing.members) {
    rows.push_back(
        {{"member", name}, {"status", member_open}, {"reason", "in none of the folders"}});
  }
  std::sort(rows.begin(), rows.end(),
            [](const auto& a, const auto& b) { return a.at("member") < b.at("member"); });
  write_collected_tables(out, rows);
  write_atomically(out / "provenance.json",
                   merged_provenance(folders, missing.empty()).dump(2) + "\n");
  return missing;
}

}  // namespace

void merge_results(const std::vector<fs::path>& folders, const fs::path& out) {
  if (fs::exists(out))
    throw InputError(out.string() + " is there already; name a folder that is not");
  require_one_collection(folders);
  fs::path unfinished = out;
  if (!unfinished.has_filename()) unfinished = unfinished.parent_path();
  unfinished += ".unfinished";
  Missing missing;
  try {
    fs::remove_all(unfinished);
    missing = write_merged(folders, unfinished);
    fs::rename(unfinished, out);
  } catch (const fs::filesystem_error& error) {
    fs::remove_all(unfinished);
    throw InputError("cannot write " + out.string() + ": " + error.code().message());
  } catch (...) {
    fs::remove_all(unfinished);
    throw;
  }
  if (!missing.empty()) throw InputError(sentence(missing, out));
}

}  // namespace smoothfem
