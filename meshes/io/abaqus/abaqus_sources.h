// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "meshes/io/line_reader.h"

namespace smoothfem {

/// The lines of an input file and of the files that it includes, in the order in which Abaqus reads
/// them. Only those of nearby_file() may be included.
class AbaqusSources {
 public:
  /// The content of the main file must outlive the object.
  AbaqusSources(const std::filesystem::path& path, std::string_view content);

  /// Goes to the next line that is not blank; false at the end of the main file.
  bool next_line();
  /// Returns the reader of the present line.
  LineReader& reader() { return sources_.back()->reader; }
  const LineReader& reader() const { return sources_.back()->reader; }
  /// Returns the number of the present line, or of the line in the main file that includes it.
  std::size_t line() const { return sources_.front()->reader.line(); }
  const LineReader& main_reader() const { return sources_.front()->reader; }

  /// Marks the present line as the beginning of a keyword.
  void mark_keyword();
  /// Continues with the lines of another file. In the whole text, `replacement` takes the place of
  /// the lines from the marked one to the present one. Throws InputError for a file that may not be
  /// read.
  void include(const std::string& name, std::string_view replacement);

  /// Number of files included so far.
  std::size_t n_included() const { return n_included_; }
  /// Returns the text of all files, after the last line: that of the main file in which the text of
  /// each included file is in place.
  std::string whole_text() &&;

 private:
  struct Source {
    std::filesystem::path path;  ///< without links
    std::string own;             ///< content of an included file
    std::string_view content;
    LineReader reader;
    std::size_t n_copied = 0;  ///< characters that are in the text
    std::size_t keyword = 0;   ///< where the marked line begins

    Source(const std::filesystem::path& name, std::string text)
        : own(std::move(text)), content(own), reader(name, content, separators) {}
    Source(const std::filesystem::path& name, std::string_view text)
        : content(text), reader(name, content, separators) {}
  };

  static constexpr std::string_view separators = ", \t\r\v\f";

  std::filesystem::path allowed_path(const std::string& name) const;
  void copy_up_to(Source& source, std::size_t end);

  std::filesystem::path main_;                    ///< as the user wrote it
  std::vector<std::unique_ptr<Source>> sources_;  ///< each includes the next one
  std::string text_;
  std::size_t n_included_ = 0;
};

}  // namespace smoothfem
