#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace smoothfem {

/// The whole file as bytes. Throws InputError for a missing file, a folder, a file that cannot be
/// read, and an empty one.
std::string read_whole_file(const std::filesystem::path& path);

/// Reads a text line by line and each line word by word, and knows where it is for error messages.
/// The content must outlive the reader.
class LineReader {
 public:
  LineReader(const std::filesystem::path& path, std::string_view content)
      : path_(path.string()), rest_(content) {}

  /// Goes to the next line that is not blank; false at the end of the text.
  bool next_line();
  /// The same where another line has to come; `what` says which ("node 5 of 11").
  void require_line(const std::string& what);

  /// Number of the current line, from 1.
  std::size_t line() const { return line_; }
  std::string_view text() const { return text_; }
  /// Bytes that follow the current line.
  std::string_view rest() const { return rest_; }

  /// The next word of the line; empty at its end.
  std::string_view word();
  /// The next word as a finite number; `what` is its name in the error message.
  double number(const std::string& what);
  /// The next word as an integer in [0, limit).
  std::uint64_t integer(const std::string& what, std::uint64_t limit = UINT64_MAX);
  /// The line must have no further word.
  void require_end_of_line();

  /// Throws InputError "path:line: message".
  [[noreturn]] void fail(const std::string& message) const;

 private:
  std::string path_;
  std::string_view rest_, text_, unread_;
  std::size_t line_ = 0;
};

}  // namespace smoothfem
