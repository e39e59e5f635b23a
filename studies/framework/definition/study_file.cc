// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/definition/study_file.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>

#include "smoothing/base/find_named.h"
#include "smoothing/base/text.h"
#include "studies/framework/definition/find_study.h"
#include "studies/framework/definition/parse_messages.h"

namespace smoothfem {

using dealii::ParameterHandler;

std::string read_study_text(const std::filesystem::path& file) {
  // Pipes and devices may have no end.
  std::error_code ignored;  // a missing file cannot be opened
  const auto status = std::filesystem::status(file, ignored);
  std::ifstream stream;
  if (std::filesystem::is_regular_file(status)) stream.open(file);
  std::ostringstream content;
  content << stream.rdbuf();
  const bool is_there = std::filesystem::exists(status);
  if (!stream.is_open() || stream.bad())
    throw InputError(file.string() + (is_there && !std::filesystem::is_regular_file(status)
                                          ? ": this is not a regular file; give a study file"
                                          : ": cannot read this study file; check its path"));
  std::string text = content.str() + "\n";
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
  if (text.find('\n') + 1 == text.size())  // lines may end by '\r' alone
    std::replace(text.begin(), text.end(), '\r', '\n');
  return text;
}

namespace {

std::vector<std::string> declared_keys(ParameterHandler& p) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : all_parameters(p)) keys.push_back(key);
  return keys;
}

/// Throws InputError if a subsection has the name of a key. deal.II would enter it, and then miss
/// its keys.
void refuse_keys_as_subsections(ParameterHandler& p, const StudyText& text) {
  const auto keys = declared_keys(p);
  std::istringstream lines(text.text());
  int depth = 0, number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const StudyLine read = study_line(line);
    if (read.kind == StudyLine::Kind::end) --depth;
    if (read.kind != StudyLine::Kind::subsection) continue;
    if (depth++ == 0 && std::find(keys.begin(), keys.end(), read.name) != keys.end())
      throw parse_error(text,
                        "Line <" + std::to_string(number) + "> of file <" + study_file_in_messages +
                            ">: There is no such subsection to be entered: " + read.name,
                        keys);
  }
}

std::string_view trimmed(std::string_view text) {
  constexpr const char* blanks = " \t\r";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Returns the words of a text with single blanks between them.
std::string with_single_blanks(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool is_blank = c == ' ' || c == '\t';
    if (!is_blank || !result.ends_with(' ')) result += is_blank ? ' ' : c;
  }
  return result;
}

}  // namespace

void parse_study(ParameterHandler& p, const StudyText& text, bool skip_undefined) {
  if (!skip_undefined) refuse_keys_as_subsections(p, text);
  std::istringstream stream(text.text());
  try {
    p.parse_input(stream, study_file_in_messages, "", skip_undefined);
  } catch (const dealii::ExceptionBase& error) {
    throw parse_error(text, error.what(), declared_keys(p));
  }
}

void check_label(const std::string& label, const std::string& what, const std::string& file) {
  const bool is_allowed =
      !label.empty() && label != "." && label != ".." &&
      std::all_of(label.begin(), label.end(), [](unsigned char c) {
        return (c < 0x80 && std::isalnum(c) != 0) || c == '.' || c == '_' || c == '-';
      });
  if (!is_allowed)
    throw InputError(file + ": the " + what + " label '" + shortened(label) +
                     "' may only have letters, digits, '.', '_' and '-'");
}

std::vector<std::string> known_scales(const dealii::ParameterHandler& lists,
                                      const std::string& scale, const std::string& file) {
  std::vector<std::string> known = split_list(lists.get("scales"));
  if (scale.empty() || std::find(known.begin(), known.end(), scale) != known.end()) return known;
  throw InputError(file + ": the study has no scale '" + scale + "'; " +
                   (known.empty() ? "it has one size only: leave --scale out"
                                  : choose_one_of(known, scale) + ", or leave --scale out"));
}

StudyLine study_line(std::string_view line) {
  line = trimmed(line.substr(0, line.find('#')));
  const std::string_view word = line.substr(0, line.find_first_of(" \t"));
  const std::string_view rest = trimmed(line.substr(word.size()));
  if (line == "end") return {StudyLine::Kind::end};
  if (word == "subsection") return {StudyLine::Kind::subsection, with_single_blanks(rest)};
  const auto equals = rest.find('=');
  if (word != "set" || equals == std::string_view::npos) return {};
  return {StudyLine::Kind::set, with_single_blanks(trimmed(rest.substr(0, equals))),
          std::string(trimmed(rest.substr(equals + 1)))};
}

std::vector<std::pair<std::string, std::string>> keys_of_sections(const StudyText& text) {
  std::vector<std::pair<std::string, std::string>> keys;
  std::vector<std::string> sections;
  std::istringstream lines(text.text());
  for (std::string line; std::getline(lines, line);) {
    const StudyLine read = study_line(line);
    if (read.kind == StudyLine::Kind::subsection) sections.push_back(read.name);
    if (read.kind == StudyLine::Kind::end && !sections.empty()) sections.pop_back();
    if (read.kind == StudyLine::Kind::set && sections.size() == 1)
      keys.emplace_back(sections[0], read.name);
  }
  return keys;
}

std::map<std::string, std::string> lines_of_section(const StudyText& text,
                                                    const std::string& section) {
  std::map<std::string, std::string> found;
  std::vector<std::string> sections;
  std::istringstream lines(text.text());
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const StudyLine read = study_line(line);
    if (read.kind == StudyLine::Kind::subsection) sections.push_back(read.name);
    if (read.kind == StudyLine::Kind::end && !sections.empty()) sections.pop_back();
    const std::string here = sections.empty() ? "" : sections[0];
    if (read.kind == StudyLine::Kind::set && sections.size() < 2 && here == section)
      found[read.name] = text.position(number);
  }
  return found;
}

std::string with_line(const std::map<std::string, std::string>& lines, const std::string& message) {
  constexpr std::string_view of_group = " group ";
  for (const auto& [key, position] : lines) {
    const auto at = key.find(of_group);
    const std::string group = at == std::string::npos ? key : key.substr(at + of_group.size());
    for (const auto& name : {key, group})
      if (message.find("'" + name + "'") != std::string::npos) return position + ": " + message;
  }
  for (const std::string key : {"u", "value"})
    if (const auto found = lines.find(key); found != lines.end())
      return found->second + ": " + message;
  return message;
}

StudyParameters all_parameters(ParameterHandler& p) {
  StudyParameters result;
  std::ostringstream text;
  p.print_parameters(text, ParameterHandler::ShortPRM);
  std::istringstream lines(text.str());
  std::vector<std::string> prefix{""};
  for (std::string line; std::getline(lines, line);) {
    const StudyLine read = study_line(line);
    if (read.kind == StudyLine::Kind::subsection) prefix.push_back(prefix.back() + read.name + "/");
    if (read.kind == StudyLine::Kind::end) prefix.pop_back();
    if (read.kind == StudyLine::Kind::set)
      result.emplace_back(prefix.back() + read.name, read.value);
  }
  return result;
}

void declare_scales(ParameterHandler& p) {
  p.declare_entry("scales", "", dealii::Patterns::Anything(),
                  "Sizes that --scale can choose, separated by commas; each has a subsection "
                  "'scale NAME'.");
}

namespace {

/// Returns the key of a path "SUBSECTION/KEY" or "KEY".
std::string last_name(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

}  // namespace

void apply_scale(ParameterHandler& p, const std::string& scale, const std::string& file,
                 const std::vector<std::string>& numbers, const std::vector<std::string>& lists) {
  if (scale.empty()) return;
  StudyParameters changes;
  {
    const Subsection subsection(p, "scale " + scale);
    for (const auto& key : numbers)
      if (std::stod(p.get(key)) != 0.0) changes.emplace_back(key, p.get(key));
    for (const auto& path : lists)
      if (const std::string value = p.get(last_name(path)); !value.empty())
        changes.emplace_back(path, value);
  }
  for (const auto& [path, value] : changes) try {
      const std::string key = last_name(path);
      std::optional<Subsection> subsection;
      if (key != path) subsection.emplace(p, path.substr(0, path.size() - key.size() - 1));
      p.set(key, value);
    } catch (const dealii::ExceptionBase&) {
      throw InputError(file + ": the scale " + scale + " has '" + last_name(path) + " = " + value +
                       "', which is out of range; 'smoothfem list --study-keys' shows the range");
    }
}

std::string commented_keys(ParameterHandler& p) {
  std::ostringstream text;
  p.print_parameters(text, ParameterHandler::PRM | ParameterHandler::KeepDeclarationOrder);
  return text.str();
}

void declare_table_study(ParameterHandler& p, const std::string& kind) {
  namespace Patterns = dealii::Patterns;
  p.declare_entry("kind", kind, Patterns::Selection(kind),
                  "Kind of study; other kinds have other keys.");
  p.declare_entry("title", "", Patterns::Anything(), "Title in tables and figures.");
  declare_scales(p);
}

void declare_table_scale(ParameterHandler& p, const std::string& scale,
                         const std::vector<std::string>& numbers) {
  const Subsection subsection(p, "scale " + scale);
  for (const auto& key : numbers)
    p.declare_entry(key, "0", dealii::Patterns::Integer(0),
                    "Replaces the value above; 0: no change.");
}

StudyHeader read_table_study(ParameterHandler& p, const std::filesystem::path& file,
                             const std::string& scale, const std::vector<std::string>& numbers) {
  const StudyText text(file);
  ParameterHandler lists;  // the lists determine which subsections exist
  declare_scales(lists);
  parse_study(lists, text, true);
  const auto scales = known_scales(lists, scale, file.string());
  for (const auto& name : scales) declare_table_scale(p, name, numbers);
  parse_study(p, text, false);

  StudyHeader header;
  header.name = file.stem().string();
  header.title = p.get("title").empty() ? header.name : p.get("title");
  header.scale = scale;
  header.built_in = is_built_in(file);
  header.file_parameters = all_parameters(p);
  check_label(header.name, "study", file.string());
  apply_scale(p, scale, file.string(), numbers);
  header.parameters = all_parameters(p);
  return header;
}

}  // namespace smoothfem
