// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace smoothfem {

/// A file that accepts all writes and remembers the first error. For writers that do not check
/// their stream or crash at a failed write, like those of VTK. Call finish() to check.
class ErrorLatchingFilebuf final : public std::filebuf {
 public:
  /// Opens an empty file for writing.
  explicit ErrorLatchingFilebuf(const std::filesystem::path& path) {
    errno = 0;
    if (!open(path, std::ios::out | std::ios::binary)) latch();
  }

  /// Closes the file. Throws std::runtime_error with the reason unless it is complete.
  void finish() {
    if (!close()) latch();
    if (error_ != 0) throw std::runtime_error(std::strerror(error_));
  }

 protected:
  // After an error the base class is never called again: libstdc++ leaves its buffer full, and the
  // next overflow() would write beyond it.
  int_type overflow(int_type c) override {
    if (error_ == 0 && traits_type::eq_int_type(std::filebuf::overflow(c), traits_type::eof()))
      latch();
    return traits_type::not_eof(c);
  }
  std::streamsize xsputn(const char* bytes, std::streamsize n) override {
    if (n > 0 && n <= epptr() - pptr()) {  // VTK writes four bytes at a time
      std::memcpy(pptr(), bytes, static_cast<std::size_t>(n));
      pbump(static_cast<int>(n));
    } else if (error_ == 0 && std::filebuf::xsputn(bytes, n) != n) {
      latch();
    }
    return n;
  }
  int sync() override {
    if (error_ == 0 && std::filebuf::sync() != 0) latch();
    return 0;
  }

 private:
  void latch() {
    if (error_ == 0) error_ = errno != 0 ? errno : EIO;
    setp(nullptr, nullptr);  // data that could not be written are dropped
  }

  int error_ = 0;
};

}  // namespace smoothfem
