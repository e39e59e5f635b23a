// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "studies/framework/definition/included_files.h"
#include "studies/framework/definition/study_header.h"

namespace smoothfem {

/// Returns the study file and the files that it includes.
std::vector<std::filesystem::path> files_of(const StudyText& text);

/// Returns the files and folders that the values of a study's keys name: meshes, programs, plugins,
/// and all Python files next to a smoother in Python. Of a pattern it returns the folder.
std::vector<std::filesystem::path> named_files(const StudyParameters& parameters,
                                               const std::filesystem::path& folder);

}  // namespace smoothfem
