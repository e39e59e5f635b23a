// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace smoothfem {

/// Returns the whole file as bytes. Throws InputError for a missing file, a folder, a device, a
/// file that cannot be read, and an empty file.
std::string read_whole_file(const std::filesystem::path& path);

/// Returns a word in quotation marks for error messages: its first 40 bytes, followed by "..." if
/// there are more. Control characters, which could garble the terminal, become '?'.
std::string in_quotes(std::string_view word);

/// Changes Latin capital letters to small ones.
std::string lower_case(std::string_view text);

/// Reads a text line by line and each line word by word. Keeps the position for error messages. The
/// content must outlive the reader.
class LineReader {
 public:
  static constexpr char no_comment = '\n';  ///< occurs in no line

  /// separators: characters between words.
  LineReader(const std::filesystem::path& path, std::string_view content,
             std::string_view separators = " \t\r\v\f")
      : path_(path.string()), separators_(separators), rest_(content) {}

  /// Goes to the next line that is not blank; false at the end of the text.
  bool next_line();
  /// Goes to the next line and throws InputError at the end of the text. `what` names the line
  /// ("node 5 of 11").
  void require_line(std::string_view what);

  /// Goes to the next line with a word if this one has none left, for formats that ignore line
  /// ends; false at the end of the text. `comment` begins a comment up to the end of its line.
  bool find_word(char comment = no_comment);
  /// Finds a word and throws InputError at the end of the text.
  void require_word(std::string_view what, char comment = no_comment);

  /// Returns the next line unchanged, blank or not, without reading its words; nothing at the end.
  std::optional<std::string_view> whole_line();
  /// Skips n bytes after the current line. Requires that they exist.
  void skip_bytes(std::size_t n);

  /// Number of the current line, from 1.
  std::size_t line() const { return line_; }
  std::string_view text() const { return text_; }
  /// Bytes after the current line.
  std::string_view rest() const { return rest_; }

  /// True if the line has another word.
  bool has_word() const { return unread_.find_first_not_of(separators_) != unread_.npos; }
  /// Returns the next word of the line; empty at its end.
  std::string_view word();
  /// Returns the next word as a finite number; `what` is its name in the error message.
  double number(std::string_view what);
  /// Returns the next word as an integer in [0, limit).
  std::uint64_t integer(std::string_view what, std::uint64_t limit = UINT64_MAX);
  /// Throws InputError if the line has another word.
  void require_end_of_line();

  /// Throws InputError "path:line: message", for the current line or another one.
  [[noreturn]] void fail(const std::string& message) const { fail_at(line_, message); }
  [[noreturn]] void fail_at(std::size_t line, const std::string& message) const;

 private:
  std::string path_;
  std::string_view separators_;
  std::string_view rest_, text_, unread_;
  std::size_t line_ = 0;
};

}  // namespace smoothfem
