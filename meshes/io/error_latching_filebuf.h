// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace smoothfem {

/// A file that takes everything and remembers the first error: for writers that do not look at
/// their stream, or crash where a write fails, as VTK's do. Check finish().
class ErrorLatchingFilebuf final : public std::filebuf {
 public:
  /// Opens the file for writing, empty.
  explicit ErrorLatchingFilebuf(const std::filesystem::path& path) {
    errno = 0;
    if (!open(path, std::ios::out | std::ios::binary)) latch();
  }

  /// Closes it. Throws std::runtime_error with the reason unless everything is in the file.
  void finish() {
    if (!close()) latch();
    if (error_ != 0) throw std::runtime_error(std::strerror(error_));
  }

 protected:
  // After an error the base is never called again: libstdc++ leaves its buffer full, and the next
  // overflow() would write behind it.
  int_type overflow(int_type c) override {
    if (error_ == 0 && traits_type::eq_int_type(std::filebuf::overflow(c), traits_type::eof()))
      latch();
    return traits_type::not_eof(c);
  }
  std::streamsize xsputn(const char* bytes, std::streamsize n) override {
    if (error_ == 0 && std::filebuf::xsputn(bytes, n) != n) latch();
    return n;
  }
  int sync() override {
    if (error_ == 0 && std::filebuf::sync() != 0) latch();
    return 0;
  }

 private:
  void latch() {
    if (error_ == 0) error_ = errno != 0 ? errno : EIO;
    setp(nullptr, nullptr);  // what could not be written is dropped
  }

  int error_ = 0;
};

}  // namespace smoothfem
