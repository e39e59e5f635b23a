// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/results/results_folder.h"

#include "meshes/io/atomic_file.h"

namespace smoothfem {

namespace fs = std::filesystem;

void require_writable(const fs::path& folder) {
  const std::string reason = why_not_writable(folder);
  if (!reason.empty())
    throw InputError("cannot write results to " + folder.string() + ": " + reason);
}

void require_published_files(const Study& study, const fs::path& mesh_dir) {
  if (mesh_dir.empty()) return;
  for (const auto& mesh : study.meshes)
    if (!mesh.published_file.empty()) return;
  throw InputError("--mesh-dir is given, but no mesh of the study " + study.header.name +
                   " names a published file; leave it out or set 'published file' for a mesh");
}

std::string move_old_results(const fs::path& folder) {
  if (!fs::exists(folder) || fs::is_empty(folder)) return {};
  fs::path plain = folder;
  if (!plain.has_filename()) plain = plain.parent_path();
  fs::path other;
  for (int i = 1; other.empty() || fs::exists(other); ++i) {
    other = plain;
    other += "_" + std::to_string(i);
  }
  std::error_code error;
  fs::rename(plain, other, error);
  if (error)
    throw InputError("cannot rename " + plain.string() + " to " + other.string() + ": " +
                     error.message());
  return "The earlier results are now in " + other.string() + ".";
}

void make_results_folder(const fs::path& folder, std::optional<FolderLock>& lock) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError("cannot make the folder " + folder.string() + ": " + error.message());
  lock.reset();  // a process cannot take over its own lock
  lock.emplace(folder);
  if (!read_provenance(folder / "provenance.json").status.empty())
    throw FolderTaken("another run has begun to write its results into " + folder.string() +
                      " in the meantime; start this one again, or take another --out");
}

void check_settings_match(const EarlierRun& earlier, const StudyHeader& study,
                          const std::vector<MeshFacts>& meshes,
                          const std::vector<StudyMethod>& methods, const fs::path& folder) {
  if (earlier.status.empty()) return;
  auto settings = settings_of(study, meshes, methods);
  std::string differences;
  int n_differences = 0;
  const auto note = [&](const std::string& key, const std::string& then, const std::string& now) {
    constexpr int most = 5;
    if (++n_differences <= most)
      differences +=
          (n_differences == 1 ? "" : "; ") + key + " was '" + then + "' and is '" + now + "'";
    else if (n_differences == most + 1)
      differences += "; and more";
  };
  for (const auto& [key, then] : earlier.settings) {
    const bool of_file =
        key.find(" of mesh ") != std::string::npos || key.starts_with("content of method ");
    if (of_file && meshes.empty()) continue;
    if (settings[key] != then) note(key, then, settings[key]);
  }
  for (const auto& [key, now] : settings)
    if (!earlier.settings.contains(key) && !now.empty()) note(key, "", now);
  if (n_differences > 0)
    throw InputError("the results in " + folder.string() + " are those of another run (" +
                     differences +
                     "); start anew with --force, which keeps them under another name, or take "
                     "another --out");
}

}  // namespace smoothfem
