// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "meshes/io/abaqus/abaqus_sources.h"
#include "meshes/io/line_reader.h"

namespace smoothfem {

std::string capitals(std::string_view text);

/// Returns the text without blanks at its beginning and end.
std::string_view trimmed(std::string_view text);

/// The lines of an Abaqus input file: keyword lines "*NAME, KEY=VALUE, KEY" that may continue after
/// a comma, data lines of fields between commas, comments "**". The lines of included files
/// (*INCLUDE, and INPUT= of nodes, elements and sets) are in place.
class AbaqusLines {
 public:
  AbaqusLines(const std::filesystem::path& path, std::string_view content)
      : sources_(path, content) {}

  /// Goes to the next keyword line, past unread data lines; false at the end of the file.
  bool next_keyword();
  /// Returns the name of the keyword in capitals, without the asterisk.
  const std::string& keyword() const { return keyword_; }
  /// Returns the value of a key as written, without quotes; `fallback` if the key is missing. key:
  /// in capitals.
  std::string parameter(std::string_view key, const std::string& fallback = {}) const;
  bool has_parameter(std::string_view key) const;

  /// Goes to the next data line of the keyword; false if there is no further one.
  bool next_data();
  bool has_field() const { return sources_.reader().has_word(); }
  std::size_t label(std::string_view what) { return sources_.reader().integer(what); }
  double number(std::string_view what) { return sources_.reader().number(what); }
  /// Returns the next field, a label or a name.
  std::string_view entry() { return sources_.reader().word(); }
  /// Tells for each field of the data line whether nothing is in it. A comma at the end adds none.
  std::vector<bool> empty_fields() const;

  /// Returns the contents of all comments so far that begin with abaqus_name_comment.
  const std::vector<std::string>& name_comments() const { return name_comments_; }

  /// Returns the number of the line in the main file; for lines of an included file, of that which
  /// includes it.
  std::size_t line() const { return sources_.line(); }
  [[noreturn]] void fail(const std::string& message) const { sources_.reader().fail(message); }
  /// line: of the main file.
  [[noreturn]] void fail_at(std::size_t line, const std::string& message) const {
    sources_.main_reader().fail_at(line, message);
  }

  std::size_t n_included() const { return sources_.n_included(); }
  /// Returns the text of all files as one, after the last line; empty if no file is included.
  std::string whole_text() && {
    return sources_.n_included() == 0 ? std::string() : std::move(sources_).whole_text();
  }

 private:
  bool next_line();
  bool next_line_of_files();
  void read_keyword_line();
  void split_keyword_line(std::string text);
  std::string keyword_line_without_input() const;

  AbaqusSources sources_;
  bool at_keyword_ = false;  ///< the current line is an unread keyword line
  bool is_open_ = false;     ///< the first comment of a file was found, but not yet the last one
  std::string keyword_;
  std::vector<std::pair<std::string, std::string>> parameters_;
  std::vector<std::string> name_comments_;
};

}  // namespace smoothfem
