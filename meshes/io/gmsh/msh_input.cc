// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/gmsh/msh_input.h"

#include <charconv>

#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

std::string end_of(const std::string& section) {
  // Version 1 has capitals.
  return (section == "$NOD" || section == "$ELM" ? "$END" : "$End") + section.substr(1);
}

}  // namespace

// --- Text ----------------------------------------------------------------------------------------

std::string MshTextInput::next_section() {
  if (!reader_.next_line()) return {};
  std::string section(reader_.word());
  if (section.front() != '$' || section.starts_with("$End") || section.starts_with("$END"))
    fail("expected the beginning of a section; the previous section has more lines than announced");
  return section;
}

std::string MshTextInput::skip_section(const std::string& section) {
  const char* const begin = reader_.rest().data();
  do reader_.require_line(end_of(section));
  while (!reader_.text().starts_with(end_of(section)));
  return section + "\n" + std::string(begin, reader_.text().data()) + end_of(section) + "\n";
}

void MshTextInput::require_end(const std::string& section) {
  reader_.require_line(end_of(section));
  if (reader_.word() != end_of(section))
    fail("expected " + end_of(section) + "; the section has more lines than announced");
}

void MshTextInput::begin(const char* what, std::uint64_t i, std::uint64_t n) {
  if (!reader_.next_line())
    reader_.require_line(std::string(what) + " " + std::to_string(i + 1) + " of " +
                         std::to_string(n));
}

std::string_view MshTextInput::text_line(const char* what) {
  reader_.require_line(what);
  return reader_.text();
}

void MshTextInput::skip_number(const char* what) {
  if (reader_.word().empty()) fail(std::string(what) + " is missing at the end of the line");
}

std::int64_t MshTextInput::signed_integer(const char* of, std::int64_t least, std::int64_t most) {
  const std::string_view word = reader_.word();
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool is_integer = error != std::errc::invalid_argument && end == word.data() + word.size();
  if (is_integer && error == std::errc() && value >= least && value <= most) return value;
  const std::string line = std::string("the ") + of + "'s line ";
  if (word.empty()) fail(line + "ends before its last number");
  fail(line + "holds " + in_quotes(word) + ", which is not an integer" +
       (!is_integer         ? ""
        : most == INT32_MAX ? " of 32 bits"
                            : " of 64 bits"));
}

// --- Binary --------------------------------------------------------------------------------------

MshBinaryInput::MshBinaryInput(std::string path, std::string_view content, std::size_t begin,
                               bool is_version_4)
    : path_(std::move(path)), content_(content), at_(begin), is_version_4_(is_version_4) {
  constexpr std::int32_t one_swapped = 0x01000000;
  const auto one = take<std::int32_t>();
  if (one != 1 && one != one_swapped)
    fail("the number that shows the byte order is " + std::to_string(one) + " instead of 1");
  is_swapped_ = one == one_swapped;
}

void MshBinaryInput::fail_at(std::size_t position, const std::string& message) const {
  throw InputError(path_ + ": at byte " + std::to_string(position) + ": " + message +
                   "; the file is truncated or damaged");
}

void MshBinaryInput::refuse(const std::string& message) const {
  throw InputError(path_ + ": at byte " + std::to_string(at_) + ": " + message);
}

bool MshBinaryInput::skip_blanks() {
  at_ = std::min(content_.find_first_not_of(" \r\n", at_), content_.size());
  return at_ < content_.size();
}

std::string MshBinaryInput::next_section() {
  if (!skip_blanks()) return {};
  const std::string_view line = text_line("a section");
  const std::string section(line.substr(0, line.find_last_not_of(" \r") + 1));
  if (!section.starts_with('$')) fail("expected the beginning of a section");
  return section;
}

std::string MshBinaryInput::skip_section(const std::string& section) {
  const std::size_t end = content_.find(end_of(section), at_);
  if (end == std::string_view::npos) fail("the section " + in_quotes(section) + " has no end");
  const std::string_view inside = content_.substr(at_, end - at_);
  at_ = end;
  require_end(section);
  return section + "\n" + std::string(inside) + end_of(section) + "\n";
}

void MshBinaryInput::require_end(const std::string& section) {
  const std::string end = end_of(section);
  if (!skip_blanks() || !content_.substr(at_).starts_with(end)) fail("expected " + end);
  at_ += end.size();
}

std::string_view MshBinaryInput::text_line(const char* what) {
  const std::size_t begin = at_, end = content_.find('\n', at_);
  if (end == std::string_view::npos) fail("the line with " + std::string(what) + " has no end");
  at_ = end + 1;
  return content_.substr(begin, end - begin);
}

}  // namespace smoothfem
