// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "smoothing/base/input_error.h"

namespace smoothfem {

/// Another process writes into the folder. The same work may succeed later.
class FolderTaken : public InputError {
 public:
  using InputError::InputError;
};

/// A lock that keeps other processes from writing into a folder of results. The system releases it
/// when the process ends in any way. It leaves no file.
class FolderLock {
 public:
  /// Throws FolderTaken if another process has the lock. A folder that does not exist is not
  /// locked, nor is one on a file system without locks.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace smoothfem
