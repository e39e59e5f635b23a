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
  /// Paths of included files are relative to the file that includes them. Throws InputError with
  /// file and line for one that cannot be read, or that includes itself.
  StudyText(const std::string& text, const std::filesystem::path& file);

  const std::string& text() const { return text_; }
  /// The study file.
  const std::string& file() const { return file_; }
  /// "FILE:LINE" of a line of the text, counted from 1.
  std::string position(std::size_t line) const;

 private:
  /// including: the files on the way to this one, the study's first.
  void add(const std::string& text, const std::vector<std::filesystem::path>& including);

  std::string file_, text_;
  std::vector<std::string> positions_;
};

}  // namespace smoothfem
