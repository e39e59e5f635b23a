// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/line_reader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>

#include "smoothing/base/input_error.h"

namespace smoothfem {

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t longest = 40;
  std::string text = "'";
  for (const char c : word.substr(0, longest))
    text += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  if (word.size() > longest) text += "...";
  return text + "'";
}

std::string read_whole_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status))
    throw InputError(path.string() + ": there is no such file; check the path");
  if (std::filesystem::is_directory(status))
    throw InputError(path.string() + ": this is a folder; give the name of a file in it");
  if (std::filesystem::is_character_file(status) || std::filesystem::is_block_file(status))
    throw InputError(path.string() + ": this is a device, which may have no end; give a file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string content;
  if (std::filesystem::is_regular_file(status)) content.reserve(std::filesystem::file_size(path));
  std::array<char, 65536> block;
  while (file.read(block.data(), block.size()) || file.gcount() > 0)
    content.append(block.data(), static_cast<std::size_t>(file.gcount()));
  if (!file.is_open() || file.bad())
    throw InputError(path.string() + ": the file cannot be read (" +
                     (errno ? std::strerror(errno) : "input error") + ")");
  if (content.empty()) throw InputError(path.string() + ": the file is empty");
  return content;
}

bool LineReader::next_line() {
  while (whole_line()) {
    if (text_.find_first_not_of(separators_) != std::string_view::npos) {
      unread_ = text_;
      return true;
    }
  }
  text_ = unread_ = {};
  return false;
}

void LineReader::require_line(std::string_view what) {
  if (!next_line()) fail("the file ends before " + std::string(what) + "; it is truncated");
}

bool LineReader::find_word(char comment) {
  for (;;) {
    const std::size_t begin = unread_.find_first_not_of(separators_);
    if (begin != std::string_view::npos && unread_[begin] != comment) return true;
    if (!next_line()) return false;
  }
}

void LineReader::require_word(std::string_view what, char comment) {
  if (!find_word(comment)) require_line(what);
}

std::optional<std::string_view> LineReader::whole_line() {
  unread_ = {};
  if (rest_.empty()) return {};
  const std::size_t end = rest_.find('\n');
  text_ = rest_.substr(0, end);
  rest_ = end == std::string_view::npos ? std::string_view{} : rest_.substr(end + 1);
  ++line_;
  return text_;
}

void LineReader::skip_bytes(std::size_t n) {
  line_ += static_cast<std::size_t>(
      std::count(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(n), '\n'));
  rest_.remove_prefix(n);
  text_ = unread_ = {};
}

std::string_view LineReader::word() {
  const std::size_t begin = unread_.find_first_not_of(separators_);
  if (begin == std::string_view::npos) {
    unread_ = {};
    return {};
  }
  unread_ = unread_.substr(begin);
  const std::string_view found = unread_.substr(0, unread_.find_first_of(separators_));
  unread_ = unread_.substr(found.size());
  return found;
}

double LineReader::number(std::string_view what) {
  std::string_view found = word();
  if (found.empty()) fail(std::string(what) + " is missing at the end of the line");
  const std::string_view as_written = found;
  if (found.front() == '+') found.remove_prefix(1);
  std::string with_e;  // Fortran writes 1.5D0
  if (const std::size_t d = found.find_first_of("dD"); d != found.npos) {
    with_e = found;
    with_e[d] = 'e';
    found = with_e;
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
  if (error == std::errc::invalid_argument || end != found.data() + found.size())
    fail(std::string(what) + " is " + in_quotes(as_written) + ", which is not a number");
  // Numbers too small for a double count as zero.
  if (error == std::errc::result_out_of_range)
    value = std::strtod(std::string(found).c_str(), nullptr);
  if (!std::isfinite(value))
    fail(std::string(what) + " is " + in_quotes(as_written) + ", which is not finite");
  return value;
}

std::uint64_t LineReader::integer(std::string_view what, std::uint64_t limit) {
  const std::string_view found = word();
  if (found.empty()) fail(std::string(what) + " is missing at the end of the line");
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
  if (error != std::errc() || end != found.data() + found.size())
    fail(std::string(what) + " is " + in_quotes(found) + ", which is not an integer of at least 0");
  if (value >= limit)
    fail(std::string(what) + " is " + std::to_string(value) + ", but must be below " +
         std::to_string(limit));
  return value;
}

void LineReader::require_end_of_line() {
  const std::string_view found = word();
  if (!found.empty()) fail("unexpected " + in_quotes(found) + " at the end of the line; remove it");
}

void LineReader::fail_at(std::size_t line, const std::string& message) const {
  throw InputError(path_ + ":" + std::to_string(line) + ": " + message);
}

}  // namespace smoothfem
