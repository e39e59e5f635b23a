// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/external/command_line.h"

#include <cstdlib>
#include <regex>
#include <sstream>

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

std::vector<double> matched_numbers(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<double> numbers;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    constexpr std::size_t longest = 10000;  // regular expressions recurse
    if (line.size() < longest && std::regex_search(line, match, expression) && match.size() > 1)
      numbers.push_back(std::strtod(match[1].str().c_str(), nullptr));
  }
  return numbers;
}

}  // namespace smoothfem
