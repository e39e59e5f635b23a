// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/definition/parse_messages.h"

#include <regex>
#include <sstream>

#include "smoothing/base/find_named.h"

namespace smoothfem {

namespace {

/// Returns the reason in a message of deal.II. The message has several lines and begins with
/// deal.II's own source line.
std::string reason_in(const std::string& message) {
  const std::string mark = "Additional information:";
  const auto begin = message.find(mark);
  std::string reason = begin == std::string::npos ? message : message.substr(begin + mark.size());
  reason = reason.substr(0, reason.find("Stacktrace"));
  reason = reason.substr(0, reason.find("\n----"));
  reason = std::regex_replace(reason, std::regex("\\s+"), " ");
  return std::regex_replace(reason, std::regex("^ +|[ .]+$"), "");
}

/// Names of keys, or of the subsections that contain them.
std::vector<std::string> names_in(const std::vector<std::string>& keys, bool of_subsections) {
  std::vector<std::string> names;
  for (const auto& key : keys) {
    const auto slash = key.rfind('/');
    if (!of_subsections)
      names.push_back(slash == std::string::npos ? key : key.substr(slash + 1));
    else if (slash != std::string::npos)
      names.push_back(key.substr(0, slash));
  }
  return names;
}

std::string no_such(const std::string& what, const std::string& wanted,
                    const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(wanted, names);
  return "there is no " + what + " '" + wanted + "' here; " +
         (nearest.empty()     ? ""
          : nearest == wanted ? "it is for another part of the file; "
                              : "did you mean '" + nearest + "'? ") +
         "'smoothfem list --study-keys' shows the available keys";
}

/// Message for an unknown subsection. Each mesh, method and solution that the study names has one.
std::string no_such_subsection(const std::string& wanted, const std::vector<std::string>& names) {
  for (const auto& [kind, list] :
       {std::pair{"mesh ", "meshes"}, {"method ", "methods"}, {"solution ", "solutions"}}) {
    if (!wanted.starts_with(kind)) continue;
    const std::string nearest = nearest_name(wanted, names);
    return "'set " + std::string(list) + "' does not name '" +
           wanted.substr(std::string(kind).size()) + "', which has a subsection here; " +
           (nearest.empty() ? "" : "did you mean '" + nearest + "'? if not, ") +
           "add it to the list, or take the subsection out";
  }
  return no_such("subsection", wanted, names);
}

/// Returns "from 1 to 20", "of at least 0" or nothing, from deal.II's bounds.
std::string bounds_text(const std::string& lower, const std::string& upper) {
  const bool bounded_above = upper != "MAX_DOUBLE" && upper != "2147483647";
  if (lower == "-MAX_DOUBLE" || lower == "-2147483648")
    return bounded_above ? " of at most " + upper : "";
  return bounded_above ? " from " + lower + " to " + upper : " of at least " + lower;
}

/// Returns the required form of a value, from deal.II's description of a pattern.
std::string pattern_text(const std::string& pattern, const std::string& value) {
  std::smatch match;
  if (std::regex_match(pattern, match,
                       std::regex(R"(\[(Integer range|Double) (.*)\.\.\.(.*) \(inclusive\)\])")))
    return (match[1] == "Double" ? "a number" : "a whole number") +
           bounds_text(match[2].str(), match[3].str());
  if (pattern.starts_with("[Integer")) return "a whole number";
  if (pattern.starts_with("[Double")) return "a number";
  if (pattern == "[Bool]") return "true or false";
  if (std::regex_match(pattern, match, std::regex(R"(\[Selection (.*) \])"))) {
    std::vector<std::string> names;
    std::istringstream choices(match[1].str());
    for (std::string name; std::getline(choices, name, '|');)
      if (!name.empty()) names.push_back(name);
    return "one of " + joined(names) +
           (nearest_name(value, names).empty()
                ? ""
                : "; did you mean '" + nearest_name(value, names) + "'?");
  }
  if (pattern.starts_with("[Map")) return "a list like 'sequential: 10, simultaneous: 2'";
  return "a list of numbers separated by commas";
}

std::string in_our_words(const std::string& reason, const std::vector<std::string>& keys) {
  const auto matches = [&](const char* expression, std::smatch& match) {
    return std::regex_match(reason, match, std::regex(expression));
  };
  std::smatch match;
  if (matches("No entry with name <(.*)> was declared in the current subsection", match))
    return no_such("key", match[1], names_in(keys, false));
  if (matches("There is no such subsection to be entered: (.*)", match))
    return no_such_subsection(match[1], names_in(keys, true));
  if (matches(
          "The entry value (.*) for the entry named (.*) does not match the given pattern: (.*)",
          match))
    return match[2].str() + " = " + match[1].str() + " is not allowed; it has to be " +
           pattern_text(match[3], match[1]);
  if (matches("There are unequal numbers of 'subsection' and 'end'.*", match))
    return "a subsection has no end; write 'end' below the keys of each";
  if (matches("There is no subsection to leave here", match))
    return "this 'end' ends no subsection; remove it";
  if (matches("The line <(.*)> could not be parsed.*", match))
    return "the line '" + match[1].str() +
           "' is not a line of a study file; begin it with set, subsection, end, include or #";
  return reason;
}

}  // namespace

InputError parse_error(const StudyText& text, const std::string& message,
                       const std::vector<std::string>& keys) {
  std::string reason = reason_in(message), position = text.file().string();
  std::smatch match;
  if (std::regex_match(reason, match, std::regex("Line <([0-9]+)> of file <[^>:]*>?: ?(.*)"))) {
    position = text.position(std::stoul(match[1]));
    reason = match[2].str();
  }
  return InputError(position + ": " + in_our_words(reason, keys));
}

}  // namespace smoothfem
