// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace smoothfem {

/// The folder of the studies that come with the program. Throws InputError if its data are missing.
std::filesystem::path built_in_studies();

/// The study files in a folder and those below it, sorted by name; empty if the folder does not
/// exist.
std::vector<std::filesystem::path> study_files(const std::filesystem::path& folder);

/// Returns the file of a study. The argument is a path, or the name of a study that comes with the
/// program. Throws InputError for anything else.
std::filesystem::path find_study(const std::string& path_or_name);

/// True if a study file has the name and the text of a study that comes with the program, wherever
/// the file is. Only then do statements of the literature apply to it. Throws InputError as
/// built_in_studies and read_study_text do.
bool is_built_in(const std::filesystem::path& file);

}  // namespace smoothfem
