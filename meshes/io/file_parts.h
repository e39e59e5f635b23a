// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace smoothfem {

/// Reads parts of a file.
class FileParts {
 public:
  /// Throws InputError.
  explicit FileParts(const std::filesystem::path& path);
  ~FileParts();
  FileParts(const FileParts&) = delete;
  FileParts& operator=(const FileParts&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  /// Fills `to` with the bytes from this position on. Throws InputError at the end of the file.
  void read(std::uint64_t position, std::span<char> to) const;
  /// Reads n numbers in the byte order of this machine.
  template <class T>
  std::vector<T> numbers(std::uint64_t position, std::size_t n) const {
    std::vector<T> result(n);
    read(position, {reinterpret_cast<char*>(result.data()), n * sizeof(T)});
    return result;
  }

 private:
  std::filesystem::path path_;
  int descriptor_;
  std::uint64_t size_ = 0;
};

}  // namespace smoothfem
