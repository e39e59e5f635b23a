// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace smoothfem {

/// Keeps other processes from writing into a folder of results, for as long as it lives; the system
/// lets go of it when the process ends, however it ends. Leaves no file.
class FolderLock {
 public:
  /// Throws InputError if another process has it. A folder that does not exist, or a file system
  /// that knows no locks, is not locked.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace smoothfem
