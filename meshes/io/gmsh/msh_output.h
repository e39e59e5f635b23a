// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

#include "smoothing/base/text.h"

namespace smoothfem {

/// Writes numbers to a .msh file as text or as bytes, through a buffer of a few kilobytes, so that
/// no mesh is held twice.
class MshOutput {
 public:
  MshOutput(const std::filesystem::path& path, bool is_binary)
      : file_(path, std::ios::binary), is_binary_(is_binary) {}

  bool is_binary() const { return is_binary_; }

  /// Writes words unchanged, in both encodings.
  void text(std::string_view words) { buffer_ += words; }

  /// Writes a number of a record; in text it is followed by a blank.
  template <class Number>
  void number(Number value) {
    if (is_binary_) {
      buffer_.append(reinterpret_cast<const char*>(&value), sizeof value);
    } else {
      append_number(buffer_, value);
      buffer_ += ' ';
    }
  }
  /// Writes a number with 16 digits in text, where an exact number is not needed.
  void rounded(double value);

  /// Ends a record: a line in text, without its last blank unless blank_stays is true.
  void end_record(bool blank_stays = false) {
    if (!is_binary_) {
      if (!blank_stays) buffer_.pop_back();
      buffer_ += '\n';
    }
    if (buffer_.size() >= large) write_buffer();
  }

  /// Throws std::runtime_error with the reason unless the file is complete.
  void finish();

 private:
  static constexpr std::size_t large = 1 << 16;

  void write_buffer();

  std::ofstream file_;
  std::string buffer_;
  bool is_binary_;
};

}  // namespace smoothfem
