// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "meshes/io/line_reader.h"

namespace smoothfem {

std::string capitals(std::string_view text);

/// The lines of an Abaqus input file: keyword lines "*NAME, KEY=VALUE, KEY" that may continue after
/// a comma, data lines of fields between commas, comments "**".
class AbaqusLines {
 public:
  AbaqusLines(const std::filesystem::path& path, std::string_view content)
      : reader_(path, content, ", \t\r\v\f") {}

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
  bool has_field() const { return reader_.has_word(); }
  std::size_t label(std::string_view what) { return reader_.integer(what); }
  double number(std::string_view what) { return reader_.number(what); }
  /// Returns the next field, or nothing if it is not a number.
  std::optional<std::size_t> label_if_number();
  /// Throws InputError if the data line has an empty field, which would shift the later ones.
  void require_no_empty_field() const;

  /// Returns the contents of all comments so far that begin with abaqus_name_comment.
  const std::vector<std::string>& name_comments() const { return name_comments_; }

  std::size_t line() const { return reader_.line(); }
  [[noreturn]] void fail(const std::string& message) const { reader_.fail(message); }
  [[noreturn]] void fail_at(std::size_t line, const std::string& message) const {
    reader_.fail_at(line, message);
  }

 private:
  bool next_line();
  void split_keyword_line(std::string text);

  LineReader reader_;
  bool at_keyword_ = false;  ///< the current line is an unread keyword line
  bool is_open_ = false;     ///< the first comment of a file was found, but not yet the last one
  std::string keyword_;
  std::vector<std::pair<std::string, std::string>> parameters_;
  std::vector<std::string> name_comments_;
};

}  // namespace smoothfem
