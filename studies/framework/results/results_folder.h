// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "studies/framework/results/folder_lock.h"
#include "studies/framework/results/provenance.h"

namespace smoothfem {

/// Throws InputError if files cannot be written below this folder. It leaves no trace, and avoids a
/// failure after hours of work.
void require_writable(const std::filesystem::path& folder);

/// Throws InputError if --mesh-dir is set but no mesh of the study names a published file.
void require_published_files(const Study& study, const std::filesystem::path& mesh_dir);

/// Renames the folder to the first free name of NAME_1, NAME_2, ..., if it holds anything. Returns
/// a sentence with the new name, or nothing.
std::string move_old_results(const std::filesystem::path& folder);

/// Makes the folder of a run that has no results yet, and locks it. The earlier lock was for a
/// missing or renamed folder. Throws InputError if another run has begun there in the meantime.
void make_results_folder(const std::filesystem::path& folder, std::optional<FolderLock>& lock);

/// Returns the differences between the settings of the earlier run in a folder and those of this
/// one, for example "title was 'A' and is 'B'"; empty if there are none, or no earlier run.
/// meshes: empty if nothing is known of them yet.
std::string differences_from(const EarlierRun& earlier, const StudyHeader& study,
                             const std::vector<MeshFacts>& meshes,
                             const std::vector<StudyMethod>& methods,
                             const std::vector<StudySolver>& solvers = {});

/// Links all results of the folder, except kept and earlier ones, into earlier/TIME below it. TIME
/// is when they were written. So they outlast a run that replaces them.
void set_aside_results(const std::filesystem::path& folder, const std::string& written);

/// Removes all but the newest n earlier results below a folder.
void remove_earlier_results(const std::filesystem::path& folder, std::size_t n);

/// Returns the names of kept results that the results in a folder, in its members and in the
/// earlier ones below it are made of.
std::set<std::string> used_results(const std::filesystem::path& folder);

/// Names of folders below a folder of results.
inline constexpr const char* kept_folder = "kept";
inline constexpr const char* earlier_folder = "earlier";

}  // namespace smoothfem
