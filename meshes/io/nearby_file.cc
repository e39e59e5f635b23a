// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/nearby_file.h"

#include <algorithm>

#include "meshes/io/line_reader.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace fs = std::filesystem;

namespace {

bool is_below(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

}  // namespace

fs::path without_links(const fs::path& path) {
  std::error_code error;
  auto result = fs::weakly_canonical(path, error);
  return error ? path : result;
}

fs::path nearby_file(const fs::path& of_file, const std::string& name, const std::string& what) {
  const fs::path folder = of_file.parent_path(), path = folder / name, real = without_links(path);
  if (!is_below(real, without_links(folder.empty() ? "." : folder)))
    throw InputError(what + " " + in_quotes(name) +
                     " is not in the folder of the mesh file, and is not read; copy it there");
  std::error_code error;
  if (!fs::is_regular_file(real, error))
    throw InputError(what + " " + in_quotes(name) +
                     " does not exist, or is not a file; it is looked for in the folder of the "
                     "mesh file");
  return path;
}

}  // namespace smoothfem
