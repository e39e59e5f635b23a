// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/results/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <string>
#include <utility>

#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

/// Returns "process 1234" from the system's list of locks, or "another process" if the list does
/// not have it.
std::string owner_of_lock(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return "another process";
  char folder[64];  // as in /proc/locks, "1: FLOCK ADVISORY WRITE 1234 08:01:4711 0 EOF"
  std::snprintf(folder, sizeof(folder), "%02x:%02x:%lu", major(status.st_dev), minor(status.st_dev),
                static_cast<unsigned long>(status.st_ino));
  std::ifstream locks("/proc/locks");
  std::string number, kind, advisory, access, process, file, rest;
  while (locks >> number >> kind >> advisory >> access >> process >> file &&
         std::getline(locks, rest))
    if (kind == "FLOCK" && file == folder && process != "0") return "process " + process;
  return "another process";
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  const bool is_taken = errno == EWOULDBLOCK;
  const std::string owner = is_taken ? owner_of_lock(descriptor_) : "";
  ::close(std::exchange(descriptor_, -1));
  if (is_taken)
    throw FolderTaken(owner + " is writing its results into " + folder.string() +
                      "; wait until it has ended, or take another --out");
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace smoothfem
