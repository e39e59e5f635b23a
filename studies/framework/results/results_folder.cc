// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/results/results_folder.h"

#include <algorithm>

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

namespace {

/// Returns the section of a key, such as "method getme"; empty if it is not of a labelled section.
std::string section_of(const std::string& key) {
  const auto end = key.find('/');
  const std::string section = key.substr(0, end);
  const bool is_labelled = section.starts_with("method ") || section.starts_with("mesh ") ||
                           section.starts_with("solution ") || section.starts_with("solver ");
  return end != std::string::npos && is_labelled ? section : "";
}

/// True if the setting is the source or the content of a mesh, a method or a solver.
bool is_of_file(const std::string& key) {
  return key.find(" of mesh ") != std::string::npos || key.starts_with("content of method ") ||
         key.starts_with("content of solver ");
}

bool has_section(const std::map<std::string, std::string>& settings, const std::string& section) {
  const auto first = settings.lower_bound(section + "/");
  return first != settings.end() && first->first.starts_with(section + "/");
}

}  // namespace

std::string differences_from(const EarlierRun& earlier, const StudyHeader& study,
                             const std::vector<MeshFacts>& meshes,
                             const std::vector<StudyMethod>& methods,
                             const std::vector<StudySolver>& solvers) {
  if (earlier.status.empty()) return {};
  const auto settings = settings_of(study, meshes, methods, solvers);
  std::string differences;
  int n_differences = 0;
  const auto add = [&](const std::string& difference) {
    constexpr int most = 5;
    ++n_differences;
    if (n_differences == most + 1) differences += "; and more";
    if (n_differences <= most) differences += (n_differences > 1 ? "; " : "") + difference;
  };
  const auto note = [&](const std::string& key, const std::string& then, const std::string& now) {
    // The values of contents are checksums, which nobody wants to read.
    add(key.starts_with("content of ") ? key + " has changed"
                                       : key + " was '" + then + "' and is '" + now + "'");
  };
  std::set<std::string> noted;  // sections that are new or gone
  const auto is_section_noted = [&](const std::string& key, const auto& others, const char* what) {
    const std::string section = section_of(key);
    if (section.empty() || has_section(others, section)) return false;
    if (noted.insert(section).second) add(section + what);
    return true;
  };
  for (const auto& [key, then] : earlier.settings) {
    if (is_of_file(key) && (meshes.empty() || !settings.contains(key))) continue;
    if (is_section_noted(key, settings, " is gone")) continue;
    const auto now = settings.find(key);
    const std::string value = now == settings.end() ? "" : now->second;
    if (value != then) note(key, then, value);
  }
  for (const auto& [key, now] : settings) {
    if (earlier.settings.contains(key) || now.empty()) continue;
    if (is_of_file(key)) continue;
    if (!is_section_noted(key, earlier.settings, " is new")) note(key, "", now);
  }
  return differences;
}

namespace {

/// Links or copies a file. A link is as good as a copy, because results are only replaced as a
/// whole.
void link_file(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_hard_link(from, to, error);
  if (error) fs::copy_file(from, to, error);
  if (error)
    throw InputError("cannot keep " + from.string() + " as " + to.string() + ": " +
                     error.message() + "; make room there, or take another --out");
}

void link_all(const fs::path& from, const fs::path& to) {
  fs::create_directories(to);
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path name = entry.path().filename();
    if (name == kept_folder || name == earlier_folder) continue;
    if (entry.is_directory())
      link_all(entry.path(), to / name);
    else if (entry.path().extension() == ".log")  // a log is not replaced, but written to
      fs::copy_file(entry.path(), to / name);
    else if (entry.is_regular_file())
      link_file(entry.path(), to / name);
  }
}

std::vector<fs::path> earlier_results(const fs::path& folder) {
  std::vector<fs::path> found;
  if (fs::is_directory(folder / earlier_folder))
    for (const auto& entry : fs::directory_iterator(folder / earlier_folder))
      found.push_back(entry.path());
  std::sort(found.begin(), found.end());  // by time
  return found;
}

}  // namespace

void set_aside_results(const fs::path& folder, const std::string& written) {
  std::string time = written;
  std::erase_if(time, [](char c) { return c == ':' || c == '-'; });
  fs::path whole = folder / earlier_folder / time;
  for (int i = 2; fs::exists(whole); ++i)  // results of the same second
    whole = folder / earlier_folder / (time + "_" + std::to_string(i));
  const fs::path unfinished = folder / earlier_folder / ".unfinished";
  fs::remove_all(unfinished);
  link_all(folder, unfinished);
  fs::rename(unfinished, whole);
}

void remove_earlier_results(const fs::path& folder, std::size_t n) {
  const auto found = earlier_results(folder);
  std::error_code ignored;  // leftovers are harmless
  for (std::size_t i = 0; i + n < found.size(); ++i) fs::remove_all(found[i], ignored);
  if (n == 0) fs::remove(folder / earlier_folder, ignored);
}

std::set<std::string> used_results(const fs::path& folder) {
  std::set<std::string> names;
  const auto add = [&](const fs::path& results) {
    names.merge(read_provenance(results / "provenance.json").kept);
  };
  auto folders = earlier_results(folder);
  folders.push_back(folder);
  for (const auto& results : folders) {
    add(results);
    if (fs::is_directory(results / "members"))
      for (const auto& member : fs::directory_iterator(results / "members")) add(member.path());
  }
  return names;
}

}  // namespace smoothfem
