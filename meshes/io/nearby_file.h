// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace smoothfem {

/// Returns a path with all links resolved, as far as it exists.
std::filesystem::path without_links(const std::filesystem::path& path);

/// Returns the path of a file that a mesh file names. It must be in the folder of that file, or
/// below it: a mesh from somebody else must not read other files of the user. Throws InputError,
/// which begins with `what`, for other files and for missing ones.
std::filesystem::path nearby_file(const std::filesystem::path& of_file, const std::string& name,
                                  const std::string& what);

}  // namespace smoothfem
