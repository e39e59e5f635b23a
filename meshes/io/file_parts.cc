// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/file_parts.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "smoothing/base/input_error.h"

namespace smoothfem {

FileParts::FileParts(const std::filesystem::path& path)
    : path_(path), descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0)
    throw InputError(path.string() + ": cannot be opened (" + std::strerror(errno) + ")");
  size_ = static_cast<std::uint64_t>(status.st_size);
}

FileParts::~FileParts() {
  ::close(descriptor_);
}

void FileParts::read(std::uint64_t position, std::span<char> to) const {
  while (!to.empty()) {
    const ssize_t n = ::pread(descriptor_, to.data(), to.size(), static_cast<off_t>(position));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw InputError(path_.string() + ": cannot be read (" + std::strerror(errno) + ")");
    if (n == 0) throw InputError(path_.string() + ": the file is truncated");
    position += static_cast<std::uint64_t>(n);
    to = to.subspan(static_cast<std::size_t>(n));
  }
}

}  // namespace smoothfem
