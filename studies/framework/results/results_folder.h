// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "studies/framework/results/folder_lock.h"
#include "studies/framework/results/provenance.h"

namespace smoothfem {

/// Before hours of work, and without leaving a trace: can files be written below this folder?
/// Throws InputError.
void require_writable(const std::filesystem::path& folder);

/// --mesh-dir must not be taken for something that it does not do. Throws InputError.
void require_published_files(const Study& study, const std::filesystem::path& mesh_dir);

/// Renames the folder, if it holds anything, to the first of NAME_1, NAME_2, ... that is not there.
void move_old_results(const std::filesystem::path& folder);

/// Makes the folder of a run that has no results yet, and locks it: until then the lock was that of
/// no folder, or of one that has another name now. Throws InputError if another run was faster.
void make_results_folder(const std::filesystem::path& folder, std::optional<FolderLock>& lock);

/// Throws InputError that says what differs if the run in a folder was one with other settings.
/// meshes: empty as long as nothing is known of them.
void check_settings_match(const EarlierRun& earlier, const StudyHeader& study,
                          const std::vector<MeshFacts>& meshes,
                          const std::vector<StudyMethod>& methods,
                          const std::filesystem::path& folder);

}  // namespace smoothfem
