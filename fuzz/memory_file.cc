// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/mman.h>
#include <unistd.h>

#include <stdexcept>

#include "fuzz/targets.h"
#include "smoothing/base/input_error.h"

namespace smoothfem::fuzz {

void require(bool condition, const std::string& rule) {
  if (!condition) throw std::logic_error(rule);
}

bool is_read(void (*read)(const std::filesystem::path&), const std::filesystem::path& path) {
  try {
    read(path);
    return true;
  } catch (const InputError& error) {
    const std::string message = error.what();
    require(message.find('\n') == message.npos, "a message has several lines: " + message);
    require(message.size() < 1000, "a message is not a sentence: " + message);
    return false;
  }
}

MemoryFile::MemoryFile() : descriptor_(memfd_create("smoothfem-fuzz", MFD_CLOEXEC)) {
  require(descriptor_ >= 0, "there is no file in memory");
}
MemoryFile::~MemoryFile() {
  close(descriptor_);
}

void MemoryFile::set(Bytes bytes) const {
  const bool is_set =
      ftruncate(descriptor_, 0) == 0 &&
      pwrite(descriptor_, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size());
  require(is_set, "the file in memory cannot be written");
}

std::filesystem::path MemoryFile::path() const {
  return "/proc/self/fd/" + std::to_string(descriptor_);
}

}  // namespace smoothfem::fuzz
