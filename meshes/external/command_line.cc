// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/external/command_line.h"

#define PCRE2_CODE_UNIT_WIDTH 8
#include <pcre2.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "smoothing/base/interruption.h"
#include "smoothing/base/text.h"
#include "smoothing/loop/smoother.h"

namespace smoothfem {

namespace {

/// Returns the end of the first word, after its closing quote.
std::size_t end_of_first_word(const std::string& command) {
  char quote = 0;
  for (std::size_t i = command.find_first_not_of(' '); i < command.size(); ++i)
    if (quote != 0)
      quote = command[i] == quote ? 0 : quote;
    else if (command[i] == '\'' || command[i] == '"')
      quote = command[i];
    else if (command[i] == ' ')
      return i;
  return command.size();
}

}  // namespace

std::string with_placeholder(std::string command, const std::string& name,
                             const std::string& value) {
  const std::string mark = "{" + name + "}";
  for (auto at = command.find(mark); at != std::string::npos;
       at = command.find(mark, at + value.size()))
    command.replace(at, mark.size(), value);
  return command;
}

bool has_placeholder(const std::string& command, const std::string& name) {
  return command.find("{" + name + "}") != std::string::npos;
}

std::string first_word(const std::string& command) {
  std::string word;
  for (const char c : command.substr(0, end_of_first_word(command)))
    if (c != '\'' && c != '"' && c != ' ') word += c;
  return word;
}

std::string after_first_word(const std::string& command) {
  return command.substr(end_of_first_word(command));
}

std::string last_line(const std::string& text) {
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  return last;
}

namespace {

/// As the library's functions take it.
const pcre2_code* code_of(const std::shared_ptr<const void>& code) {
  return static_cast<const pcre2_code*>(code.get());
}

/// Reads the number at the beginning of a group; nothing if it is not a time.
std::optional<double> time_in(const std::string& group, double unit) {
  char* end = nullptr;
  const double time = unit * std::strtod(group.c_str(), &end);
  if (end == group.c_str() || !std::isfinite(time) || time < 0.0) return std::nullopt;
  return time;
}

}  // namespace

LinePattern::LinePattern(const std::string& what, const std::string& pattern)
    : what_(what), pattern_(pattern) {
  int error = 0;
  PCRE2_SIZE position = 0;
  pcre2_code* const code = pcre2_compile(reinterpret_cast<PCRE2_SPTR>(pattern.data()),
                                         pattern.size(), 0, &error, &position, nullptr);
  if (code == nullptr)
    throw InputError(name() + " is not a regular expression; write one such as 'time: ([0-9.]+)'");
  code_ = std::shared_ptr<const void>(code, [](pcre2_code* c) { pcre2_code_free(c); });
  std::uint32_t n_groups = 0;
  pcre2_pattern_info(code, PCRE2_INFO_CAPTURECOUNT, &n_groups);
  if (n_groups == 0)
    throw InputError(name() +
                     " has no group; put the part for the number in parentheses, as in 'time: "
                     "([0-9.]+)'");
}

std::string LinePattern::name() const {
  return "the " + what_ + " '" + shortened(pattern_) + "'";
}

std::optional<std::string> LinePattern::group_in(const std::string& line) const {
  const std::unique_ptr<pcre2_match_data, decltype(&pcre2_match_data_free)> match(
      pcre2_match_data_create_from_pattern(code_of(code_), nullptr), pcre2_match_data_free);
  const int found = pcre2_match(code_of(code_), reinterpret_cast<PCRE2_SPTR>(line.data()),
                                line.size(), 0, 0, match.get(), nullptr);
  if (found == PCRE2_ERROR_NOMATCH) return std::nullopt;
  if (found < 0)  // a limit of the library
    throw SmootherFailure(name() +
                          " takes too many steps on a line that it printed; write a simpler one");
  const PCRE2_SIZE* const ends = pcre2_get_ovector_pointer(match.get());
  if (found < 2 || ends[2] == PCRE2_UNSET) return "";
  return line.substr(ends[2], ends[3] - ends[2]);
}

std::vector<std::string> LinePattern::groups_in(const std::string& text) const {
  std::vector<std::string> groups;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (interruption()) throw Interrupted{};
    constexpr std::size_t longest = 10000;  // a pattern may take a time that grows with its square
    if (line.size() >= longest) continue;
    if (auto group = group_in(line)) groups.push_back(*std::move(group));
  }
  return groups;
}

std::vector<double> times_in(const std::string& text, const LinePattern& pattern, double unit) {
  std::vector<double> times;
  for (const auto& group : pattern.groups_in(text)) {
    const auto time = time_in(group, unit);
    if (!time)
      throw SmootherFailure("it printed the time '" + shortened(group) +
                            "', which is not a number of at least 0; correct the program, or " +
                            pattern.name());
    times.push_back(*time);
  }
  return times;
}

}  // namespace smoothfem
