// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace smoothfem {

/// The text of a study file in which each line `include FILE` has become that file's lines, and
/// where its lines are from.
class StudyText {
 public:
  /// Reads the file. Paths of included files are relative to the file that includes them. Throws
  /// InputError if it cannot be read, with file and line for an included one that cannot, or that
  /// includes itself.
  explicit StudyText(const std::filesystem::path& file);

  const std::string& text() const { return text_; }
  /// The study file.
  const std::filesystem::path& file() const { return file_; }
  /// Other text for the same lines; what it has more lines than before is as if it stood in the
  /// last one.
  StudyText with_text(std::string text) const;
  /// "FILE:LINE" of a line of the text, counted from 1.
  std::string position(std::size_t line) const;

 private:
  /// including: the files on the way to this one, the study's first.
  void add(const std::string& text, const std::vector<std::filesystem::path>& including);

  std::filesystem::path file_;
  std::string text_;
  std::vector<std::string> positions_;
};

}  // namespace smoothfem
