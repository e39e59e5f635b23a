// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace smoothfem {

/// The text of a study file with included files in place of their `include FILE` lines, and the
/// origin of each line.
class StudyText {
 public:
  /// Reads the file. Paths of included files are relative to the file that includes them.
  /// Throws InputError if the file cannot be read. If an included file cannot be read or includes
  /// itself, if there are too many of them, or if a line is not UTF-8, the message has file and
  /// line.
  explicit StudyText(const std::filesystem::path& file);

  const std::string& text() const { return text_; }
  /// The study file.
  const std::filesystem::path& file() const { return file_; }
  /// The files that it includes, in the order of their lines.
  const std::vector<std::filesystem::path>& included() const { return included_; }
  /// Returns another text with the positions of this one. Additional lines get the position of the
  /// last line.
  StudyText with_text(std::string text) const;
  /// "FILE:LINE" of a line of the text, counted from 1.
  std::string position(std::size_t line) const;
  /// Returns a sentence for each key that one file sets twice in the same subsection. The last
  /// value counts. A file may set keys of files that it includes.
  std::vector<std::string> repetitions() const;

 private:
  /// including: the files on the way to this one, the study's first.
  void add(const std::string& text, const std::vector<std::filesystem::path>& including);

  std::filesystem::path file_;
  std::string text_;
  std::vector<std::string> positions_;
  std::vector<std::filesystem::path> included_;
};

}  // namespace smoothfem
