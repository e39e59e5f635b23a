// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace smoothfem::test {

/// Returns the path of a third-party mesh, which is not part of the repository. Searches the folder
/// of the environment variable SMOOTHFEM_MESHES, then ../shared/meshes, and for published meshes
/// the user's cache, where `./run study gear --published` stores them. Returns an empty path if it
/// is not found: the test is then skipped with how_to_get as its reason.
inline std::filesystem::path shared_mesh(const std::string& name) {
  const auto variable = [](const char* variable_name) -> std::filesystem::path {
    const char* value = std::getenv(variable_name);
    return value ? value : "";
  };
  const auto cache =
      variable("XDG_CACHE_HOME").empty() ? variable("HOME") / ".cache" : variable("XDG_CACHE_HOME");
  const std::vector<std::filesystem::path> folders{
      variable("SMOOTHFEM_MESHES"), SMOOTHFEM_SHARED_MESHES, cache / "smoothfem" / "published"};
  for (const auto& folder : folders)
    if (!folder.empty() && std::filesystem::is_regular_file(folder / name)) return folder / name;
  return {};
}

/// Returns the reason for a skipped test and how to get its mesh.
inline std::string how_to_get(const std::string& name) {
  return "SKIPPED: the mesh " + name +
         " is not part of the repository and was not found; set SMOOTHFEM_MESHES to its folder, or "
         "fetch the published gears by ./run study gear --published";
}

}  // namespace smoothfem::test
