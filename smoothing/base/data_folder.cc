// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/base/data_folder.h"

#include <dlfcn.h>

#include <cstdlib>

#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace fs = std::filesystem;

fs::path data_folder() {
  if (const char* chosen = std::getenv("SMOOTHFEM_DATA"); chosen && *chosen) {
    if (fs::is_directory(fs::path(chosen) / "studies")) return chosen;
    throw InputError("SMOOTHFEM_DATA is " + std::string(chosen) +
                     ", which has no folder studies; unset it, or set it to the folder "
                     "share/smoothfem of an installation");
  }
  Dl_info library{};
  dladdr(reinterpret_cast<const void*>(&data_folder), &library);
  const fs::path path = fs::weakly_canonical(library.dli_fname ? library.dli_fname : "");
  for (fs::path above = path.parent_path(); above.has_relative_path(); above = above.parent_path())
    if (fs::is_directory(above / "share/smoothfem/studies")) return above / "share/smoothfem";
  throw InputError("the data of the program are missing: no folder above " + path.string() +
                   " has share/smoothfem/studies; reinstall the program, or set SMOOTHFEM_DATA");
}

}  // namespace smoothfem
