// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/definition/parse_messages.h"

#include <optional>
#include <sstream>

#include "smoothing/base/find_named.h"
#include "smoothing/base/text.h"

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
  std::istringstream words(reason);
  std::string result;
  for (std::string word; words >> word;) result += (result.empty() ? "" : " ") + word;
  return result.substr(0, result.find_last_not_of(" .") + 1);
}

/// Returns the text between its begin and its end; nothing if it does not begin and end so. Values
/// in messages may be long, so there are no regular expressions here: they recurse.
std::optional<std::string> between(const std::string& text, std::string_view begin,
                                   std::string_view end) {
  if (text.size() < begin.size() + end.size() || !text.starts_with(begin) || !text.ends_with(end))
    return std::nullopt;
  return text.substr(begin.size(), text.size() - begin.size() - end.size());
}

/// Cuts a text in two at the last occurrence of a mark; nothing if there is none.
std::optional<std::pair<std::string, std::string>> cut_at(const std::string& text,
                                                          std::string_view mark) {
  const auto at = text.rfind(mark);
  if (at == std::string::npos) return std::nullopt;
  return std::pair{text.substr(0, at), text.substr(at + mark.size())};
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
         "'smoothfem list --study-keys' shows the keys of studies, and 'smoothfem list' those of "
         "methods and solvers";
}

/// Message for an unknown subsection. Each mesh, method, solution and solver that the study names
/// has one.
std::string no_such_subsection(const std::string& wanted, const std::vector<std::string>& names) {
  for (const auto& [kind, list] : {std::pair{"mesh ", "meshes"},
                                   {"method ", "methods"},
                                   {"solution ", "solutions"},
                                   {"solver ", "solvers"}}) {
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
  for (const auto& [begin, what] :
       {std::pair{"[Integer range ", "a whole number"}, {"[Double ", "a number"}})
    if (const auto range = between(pattern, begin, " (inclusive)]"))
      if (const auto bounds = cut_at(*range, "..."))
        return what + bounds_text(bounds->first, bounds->second);
  if (pattern.starts_with("[Integer")) return "a whole number";
  if (pattern.starts_with("[Double")) return "a number";
  if (pattern == "[Bool]") return "true or false";
  if (const auto selection = between(pattern, "[Selection ", " ]")) {
    std::vector<std::string> names;
    std::istringstream choices(*selection);
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
  if (const auto key =
          between(reason, "No entry with name <", "> was declared in the current subsection"))
    return no_such("key", *key, names_in(keys, false));
  if (const auto name = between(reason, "There is no such subsection to be entered: ", ""))
    return no_such_subsection(*name, names_in(keys, true));
  if (const auto entry = between(reason, "The entry value ", ""))
    if (const auto form = cut_at(*entry, " does not match the given pattern: "))
      if (const auto pair = cut_at(form->first, " for the entry named "))
        return pair->second + " = " + shortened(pair->first) + " is not allowed; it has to be " +
               pattern_text(form->second, pair->first);
  if (reason.starts_with("There are unequal numbers of 'subsection' and 'end'"))
    return "a subsection has no end; write 'end' below the keys of each";
  if (reason == "There is no subsection to leave here")
    return "this 'end' ends no subsection; remove it";
  if (const auto line = between(reason, "The line <", ""))
    if (const auto text = cut_at(*line, "> could not be parsed"))
      return "the line '" + shortened(text->first) +
             "' is not a line of a study file; begin it with set, subsection, end, include or #";
  return reason;
}

}  // namespace

InputError parse_error(const StudyText& text, const std::string& message,
                       const std::vector<std::string>& keys) {
  std::string reason = reason_in(message), position = text.file().string();
  // deal.II writes "Line <12> of file <this file>: reason", for some reasons without the last '>'.
  const std::string begin = "Line <", middle = std::string("> of file <") + study_file_in_messages;
  if (const auto at = reason.find(middle); reason.starts_with(begin) && at != reason.npos) {
    position = text.position(std::stoul(reason.substr(begin.size())));
    reason.erase(0, reason.find_first_not_of(">: ", at + middle.size()));
  }
  return InputError(position + ": " + in_our_words(reason, keys));
}

}  // namespace smoothfem
