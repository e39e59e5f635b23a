// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/gmsh/msh_output.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace smoothfem {

void MshOutput::rounded(double value) {
  if (is_binary_) return number(value);
  char digits[32];
  buffer_.append(
      digits,
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 16).ptr);
  buffer_ += ' ';
}

void MshOutput::write_buffer() {
  errno = 0;
  if (!file_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size())).flush())
    throw std::runtime_error(std::strerror(errno != 0 ? errno : EIO));
  buffer_.clear();
}

void MshOutput::finish() {
  write_buffer();
  file_.close();
  if (!file_) throw std::runtime_error(std::strerror(errno != 0 ? errno : EIO));
}

}  // namespace smoothfem
