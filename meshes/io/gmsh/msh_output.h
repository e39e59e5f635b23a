// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

#include "smoothing/base/text.h"

namespace smoothfem {

/// Puts numbers into a .msh file as text or as bytes. Goes through a buffer of some kilobytes, so
/// that no mesh is held twice.
class MshOutput {
 public:
  MshOutput(const std::filesystem::path& path, bool is_binary)
      : file_(path, std::ios::binary), is_binary_(is_binary) {}

  bool is_binary() const { return is_binary_; }

  /// As it stands, in both encodings.
  void text(std::string_view words) { buffer_ += words; }

  /// A number of a record; in text with a blank behind it.
  template <class Number>
  void number(Number value) {
    if (is_binary_) {
      buffer_.append(reinterpret_cast<const char*>(&value), sizeof value);
    } else {
      append_number(buffer_, value);
      buffer_ += ' ';
    }
  }
  /// The same with 16 digits in text, for what needs no exact number.
  void rounded(double value);

  /// Ends a record: a line in text, whose last blank goes unless it stays.
  void end_record(bool blank_stays = false) {
    if (!is_binary_) {
      if (!blank_stays) buffer_.pop_back();
      buffer_ += '\n';
    }
    if (buffer_.size() >= large) write_buffer();
  }

  /// Throws std::runtime_error with the reason unless everything is in the file.
  void finish();

 private:
  static constexpr std::size_t large = 1 << 16;

  void write_buffer();

  std::ofstream file_;
  std::string buffer_;
  bool is_binary_;
};

}  // namespace smoothfem
