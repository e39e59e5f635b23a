// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/definition/study_file.h"

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

#include "smoothing/base/find_named.h"
#include "smoothing/base/text.h"
#include "studies/framework/definition/find_study.h"
#include "studies/framework/definition/parse_messages.h"

namespace smoothfem {

using dealii::ParameterHandler;

std::string read_study_text(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream || std::filesystem::is_directory(file))
    throw InputError(file.string() + ": cannot read this study file; check its path");
  return text.str() + "\n";
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
    std::istringstream words(line.substr(0, line.find('#')));
    std::string first, name;
    words >> first >> name;
    for (std::string word; words >> word;) name += " " + word;
    if (first == "end") --depth;
    if (first != "subsection") continue;
    if (depth++ == 0 && std::find(keys.begin(), keys.end(), name) != keys.end())
      throw parse_error(text,
                        "Line <" + std::to_string(number) + "> of file <" + study_file_in_messages +
                            ">: There is no such subsection to be entered: " + name,
                        keys);
  }
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
  static const std::regex allowed("[A-Za-z0-9._-]+");
  if (!std::regex_match(label, allowed))
    throw InputError(file + ": the " + what + " label '" + label +
                     "' may only have letters, digits, '.', '_' and '-'");
}

void require_scale(const std::string& scale, const std::vector<std::string>& known,
                   const std::string& file) {
  if (scale.empty() || std::find(known.begin(), known.end(), scale) != known.end()) return;
  throw InputError(file + ": the study has no scale '" + scale + "'; " +
                   (known.empty() ? "it has one size only: leave --scale out"
                                  : choose_one_of(known, scale) + ", or leave --scale out"));
}

StudyParameters all_parameters(ParameterHandler& p) {
  // Compiled once, because studies have hundreds of lines and `list` reads all studies.
  static const std::regex begin("\\s*subsection (.*)"), end("\\s*end\\s*"),
      set("\\s*set (.*?)\\s*=\\s*(.*)");
  StudyParameters result;
  std::ostringstream text;
  p.print_parameters(text, ParameterHandler::ShortPRM);
  std::istringstream lines(text.str());
  std::vector<std::string> prefix;
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_match(line, match, begin))
      prefix.push_back(match[1].str() + "/");
    else if (std::regex_match(line, end))
      prefix.pop_back();
    else if (std::regex_match(line, match, set)) {
      std::string key;
      for (const auto& part : prefix) key += part;
      result.emplace_back(key + match[1].str(), match[2].str());
    }
  }
  return result;
}

void declare_scales(ParameterHandler& p) {
  p.declare_entry("scales", "", dealii::Patterns::Anything(),
                  "Sizes that --scale can choose, separated by commas; each has a subsection "
                  "'scale NAME'.");
}

void apply_scale(ParameterHandler& p, const std::string& scale, const std::string& file,
                 const std::vector<std::string>& numbers, const std::vector<std::string>& lists) {
  if (scale.empty()) return;
  StudyParameters changes;
  {
    const Subsection subsection(p, "scale " + scale);
    for (const auto& key : numbers)
      if (std::stod(p.get(key)) != 0.0) changes.emplace_back(key, p.get(key));
    for (const auto& key : lists)
      if (!p.get(key).empty()) changes.emplace_back(key, p.get(key));
  }
  for (const auto& [key, value] : changes) try {
      p.set(key, value);
    } catch (const dealii::ExceptionBase&) {
      throw InputError(file + ": the scale " + scale + " has '" + key + " = " + value +
                       "', which is out of range; 'smoothfem list --study-keys' shows the range");
    }
}

std::string commented_keys(ParameterHandler& p) {
  std::ostringstream text;
  p.print_parameters(text, ParameterHandler::PRM);
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
  const auto scales = split_list(lists.get("scales"));
  require_scale(scale, scales, file.string());
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
