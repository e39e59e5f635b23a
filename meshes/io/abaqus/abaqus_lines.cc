// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/abaqus/abaqus_lines.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "meshes/io/abaqus/abaqus_file.h"

namespace smoothfem {

namespace {

constexpr std::string_view blanks = " \t\r\v\f";

std::string unquoted(std::string_view text) {
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
    text = text.substr(1, text.size() - 2);
  return std::string(text);
}

/// Splits at commas outside of quotes.
std::vector<std::string_view> split_at_commas(std::string_view text) {
  std::vector<std::string_view> parts;
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i < text.size() && text[i] == '"') quoted = !quoted;
    if (i == text.size() || (text[i] == ',' && !quoted)) {
      parts.push_back(trimmed(text.substr(begin, i - begin)));
      begin = i + 1;
    }
  }
  return parts;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::string capitals(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return result;
}

bool AbaqusLines::next_line_of_files() {
  while (sources_.next_line()) {
    const std::string_view text = sources_.reader().text();
    if (text.starts_with(abaqus_name_comment))
      name_comments_.emplace_back(trimmed(text.substr(abaqus_name_comment.size())));
    if (!text.starts_with("**")) return true;
    if (trimmed(text) == abaqus_first_comment) is_open_ = true;
    if (trimmed(text) == abaqus_last_comment) is_open_ = false;
  }
  return false;
}

/// Follows *INCLUDE wherever it stands, also between the data lines of a keyword.
bool AbaqusLines::next_line() {
  while (next_line_of_files()) {
    const std::string_view text = trimmed(sources_.reader().text());
    if (capitals(trimmed(text.substr(0, text.find(',')))) != "*INCLUDE") return true;
    const auto keyword = std::exchange(keyword_, {});
    const auto parameters = std::exchange(parameters_, {});
    read_keyword_line();
    sources_.include(parameter("INPUT"), "");
    keyword_ = keyword;
    parameters_ = parameters;
  }
  return false;
}

bool AbaqusLines::next_keyword() {
  while (!at_keyword_) {
    if (!next_line()) {
      if (is_open_) fail("the last line that smoothfem writes is missing; the file is truncated");
      return false;
    }
    at_keyword_ = trimmed(sources_.reader().text()).starts_with('*');
  }
  at_keyword_ = false;
  read_keyword_line();
  constexpr std::array of_mesh{"NODE", "ELEMENT", "NSET", "ELSET"};
  if (has_parameter("INPUT") &&
      std::find(of_mesh.begin(), of_mesh.end(), keyword_) != of_mesh.end())
    sources_.include(parameter("INPUT"), keyword_line_without_input());
  return true;
}

void AbaqusLines::read_keyword_line() {
  sources_.mark_keyword();
  std::string text(trimmed(sources_.reader().text()));
  while (text.ends_with(',')) {
    if (!next_line_of_files()) fail("the keyword line ends with a comma, but nothing follows");
    text += trimmed(sources_.reader().text());
  }
  split_keyword_line(std::move(text));
}

std::string AbaqusLines::keyword_line_without_input() const {
  std::string text = "*" + keyword_;
  for (const auto& [name, value] : parameters_) {
    if (name == "INPUT") continue;
    text += ", " + name;
    if (!value.empty())
      text += "=" + (value.find_first_of(", ") == value.npos ? value : '"' + value + '"');
  }
  return text + "\n";
}

void AbaqusLines::split_keyword_line(std::string text) {
  parameters_.clear();
  const auto parts = split_at_commas(text);
  keyword_ = capitals(trimmed(parts.front().substr(1)));
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::size_t equals = parts[i].find('=');
    const std::string_view value =
        equals == parts[i].npos ? std::string_view{} : trimmed(parts[i].substr(equals + 1));
    parameters_.emplace_back(capitals(trimmed(parts[i].substr(0, equals))), unquoted(value));
  }
}

bool AbaqusLines::has_parameter(std::string_view key) const {
  return std::any_of(parameters_.begin(), parameters_.end(),
                     [&](const auto& parameter) { return parameter.first == key; });
}

std::string AbaqusLines::parameter(std::string_view key, const std::string& fallback) const {
  for (const auto& [name, value] : parameters_)
    if (name == key) return value;
  return fallback;
}

bool AbaqusLines::next_data() {
  if (at_keyword_ || !next_line()) return false;
  at_keyword_ = trimmed(sources_.reader().text()).starts_with('*');
  return !at_keyword_;
}

std::vector<bool> AbaqusLines::empty_fields() const {
  const auto fields = split_at_commas(sources_.reader().text());
  std::vector<bool> empty;
  for (const auto& field : fields) empty.push_back(trimmed(field).empty());
  if (empty.size() > 1 && empty.back()) empty.pop_back();
  return empty;
}

}  // namespace smoothfem
