// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "fem/tests/all_ranks.h"

namespace smoothfem::test {

/// A folder that the root makes and removes.
class Folder {
 public:
  Folder() {
    long number = ::getpid();
    all_ranks().broadcast(number);
    path_ = std::filesystem::temp_directory_path() / ("smoothfem_parts_" + std::to_string(number));
    all_ranks().on_root([&] { std::filesystem::create_directories(path_); });
  }
  ~Folder() {
    (void)all_ranks().any(false);
    if (all_ranks().is_root()) std::filesystem::remove_all(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace smoothfem::test
