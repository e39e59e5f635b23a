// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_file.h"

/// The two encodings of a .msh file with one interface, so that the same code reads its sections. A
/// record is a line in text and has no mark in binary files. Positions are line numbers from 1 in
/// text, and bytes in binary files. All errors are InputErrors with the position.

namespace smoothfem {

class MshTextInput {
 public:
  explicit MshTextInput(LineReader reader) : reader_(std::move(reader)) {}

  /// Returns the reader at the present position.
  const LineReader& reader() const { return reader_; }
  std::size_t position() const { return reader_.line(); }
  bool is_swapped() const { return false; }
  /// Throws InputError for missing or damaged content.
  [[noreturn]] void fail(const std::string& message) const { reader_.fail(message); }
  [[noreturn]] void fail_at(std::size_t position, const std::string& message) const {
    reader_.fail_at(position, message);
  }
  /// Throws InputError for correct content that cannot be used.
  [[noreturn]] void refuse(const std::string& message) const { reader_.fail(message); }

  /// Goes to the beginning of the next section. Returns its name, or nothing at the end of the
  /// file.
  std::string next_section();
  /// Skips a section. Returns its text with the first and the last line.
  std::string skip_section(const std::string& section);
  void require_end(const std::string& section);

  /// Goes to the next record; error messages call it, for example, "node 5 of 11".
  void begin(const char* what, std::uint64_t i, std::uint64_t n);
  void begin(const char* what) { reader_.require_line(what); }
  void end() { reader_.require_end_of_line(); }
  /// Returns a record that is text in both encodings.
  std::string_view text_line(const char* what);

  /// Goes to the next line at the end of one, for records that may be broken into lines anywhere.
  void find_value(const char* what) { reader_.require_word(what); }
  bool has_value() const { return reader_.has_word(); }
  std::uint64_t count(const char* what) { return reader_.integer(what); }
  std::uint64_t tag(const char* what) { return reader_.integer(what); }
  double coordinate(const char* what) { return reader_.number(what); }
  /// of: the subject of the record.
  int integer(const char* of) { return static_cast<int>(signed_integer(of, INT32_MIN, INT32_MAX)); }
  std::int64_t node_of_element() { return signed_integer("element", INT64_MIN, INT64_MAX); }
  void skip_number(const char* what);
  /// Requires that n items of at least so many bytes each follow; checks binary files only.
  void require_bytes(std::uint64_t, std::size_t) const {}

 private:
  std::int64_t signed_integer(const char* of, std::int64_t least, std::int64_t most);

  LineReader reader_;
};

class MshBinaryInput {
 public:
  /// begin: position of the number after the version line, which shows the byte order.
  MshBinaryInput(std::string path, std::string_view content, std::size_t begin, bool is_version_4);

  std::size_t position() const { return at_; }
  [[noreturn]] void fail(const std::string& message) const { fail_at(at_, message); }
  [[noreturn]] void fail_at(std::size_t position, const std::string& message) const;
  [[noreturn]] void refuse(const std::string& message) const;

  std::string next_section();
  std::string skip_section(const std::string& section);
  void require_end(const std::string& section);
  bool is_swapped() const { return is_swapped_; }

  void begin(const char*, std::uint64_t, std::uint64_t) {}
  void begin(const char*) {}
  void end() {}
  std::string_view text_line(const char* what);

  void find_value(const char*) {}
  bool has_value() const { return true; }
  std::uint64_t count(const char*) { return size(); }
  std::uint64_t tag(const char*) { return size(); }
  double coordinate(const char*) { return take<double>(); }
  int integer(const char*) { return take<std::int32_t>(); }
  std::int64_t node_of_element() {
    return is_version_4_ ? take<std::int64_t>() : take<std::int32_t>();
  }
  void skip_number(const char*) { take<double>(); }
  void require_bytes(std::uint64_t n, std::size_t size) const {
    if (n > (content_.size() - at_) / size) fail("a count is larger than the file");
  }

 private:
  std::uint64_t size() {
    if (is_version_4_) return take<std::uint64_t>();
    const auto value = take<std::int32_t>();
    if (value < 0) fail("a count or a tag is negative");
    return static_cast<std::uint64_t>(value);
  }

  template <class T>
  T take() {
    require_bytes(1, sizeof(T));
    char bytes[sizeof(T)];
    std::memcpy(bytes, content_.data() + at_, sizeof bytes);
    if (is_swapped_) std::reverse(bytes, bytes + sizeof bytes);
    at_ += sizeof bytes;
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }

  bool skip_blanks();

  std::string path_;
  std::string_view content_;
  std::size_t at_;
  bool is_version_4_, is_swapped_ = false;
};

}  // namespace smoothfem
