// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

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

/// Throws InputError with the differences if the earlier run in the folder had other settings.
/// meshes: empty if nothing is known of them yet.
void check_settings_match(const EarlierRun& earlier, const StudyHeader& study,
                          const std::vector<MeshFacts>& meshes,
                          const std::vector<StudyMethod>& methods,
                          const std::filesystem::path& folder);

}  // namespace smoothfem
