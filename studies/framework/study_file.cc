// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/study_file.h"

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

namespace smoothfem {

using dealii::ParameterHandler;

namespace {

/// How deal.II calls the study file in its messages; the path itself could hold anything.
constexpr const char* this_file = "this file";

/// deal.II's messages run over several lines, with its own source line first and ours inside.
InputError parse_error(const std::filesystem::path& file, const std::string& what) {
  const std::string mark = "Additional information:";
  const auto begin = what.find(mark);
  std::string reason = begin == std::string::npos ? what : what.substr(begin + mark.size());
  reason = reason.substr(0, reason.find("Stacktrace"));
  reason = reason.substr(0, reason.find("\n----"));
  reason = std::regex_replace(reason, std::regex("\\s+"), " ");
  reason = std::regex_replace(reason, std::regex("^ +|[ .]+$"), "");
  std::string place = file.string();
  std::smatch match;
  if (std::regex_match(reason, match, std::regex("Line <([0-9]+)> of file <([^>:]*)>?: ?(.*)"))) {
    if (match[2] != this_file) place = match[2];  // a file that the study includes
    place += ":" + match[1].str();
    reason = match[3].str();
  }
  return InputError(place + ": " + reason +
                    "; 'smoothfem list --study-keys' shows the keys there are");
}

}  // namespace

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> items;
  std::istringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');) {
    const auto first = item.find_first_not_of(" \t");
    if (first == std::string::npos) continue;
    items.push_back(item.substr(first, item.find_last_not_of(" \t") - first + 1));
  }
  return items;
}

std::string read_study_text(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream || std::filesystem::is_directory(file))
    throw InputError(file.string() + ": cannot read this study file; check its path");
  return text.str() + "\n";
}

void parse_study(ParameterHandler& p, const std::string& text, const std::filesystem::path& file,
                 bool skip_undefined) {
  std::istringstream stream(text);
  try {
    p.parse_input(stream, this_file, "", skip_undefined);
  } catch (const dealii::ExceptionBase& error) {
    throw parse_error(file, error.what());
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
                                  : choose_one_of(known) + ", or leave --scale out"));
}

std::vector<std::pair<std::string, std::string>> effective_parameters(ParameterHandler& p) {
  std::vector<std::pair<std::string, std::string>> result;
  std::ostringstream text;
  p.print_parameters(text, ParameterHandler::ShortPRM);
  std::istringstream lines(text.str());
  std::vector<std::string> prefix;
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_match(line, match, std::regex("\\s*subsection (.*)")))
      prefix.push_back(match[1].str() + "/");
    else if (std::regex_match(line, std::regex("\\s*end\\s*")))
      prefix.pop_back();
    else if (std::regex_match(line, match, std::regex("\\s*set (.*?)\\s*=\\s*(.*)"))) {
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

std::string commented_keys(ParameterHandler& p) {
  std::ostringstream text;
  p.print_parameters(text, ParameterHandler::PRM);
  return text.str();
}

void declare_table_study(ParameterHandler& p, const std::string& kind) {
  namespace Patterns = dealii::Patterns;
  p.declare_entry("kind", kind, Patterns::Selection(kind),
                  "What the study does; other kinds have other keys.");
  p.declare_entry("title", "", Patterns::Anything(), "Title in tables and figures.");
  declare_scales(p);
}

Study read_table_study(
    ParameterHandler& p, const std::filesystem::path& file, const std::string& scale,
    const std::function<void(ParameterHandler&, const std::string&)>& declare_sizes) {
  const std::string text = read_study_text(file);
  ParameterHandler lists;  // which subsections there are depends on what the file says
  declare_scales(lists);
  parse_study(lists, text, file, true);
  const auto scales = split_list(lists.get("scales"));
  require_scale(scale, scales, file.string());
  for (const auto& name : scales) declare_sizes(p, name);
  parse_study(p, text, file, false);

  Study facts;
  facts.name = file.stem().string();
  facts.title = p.get("title").empty() ? facts.name : p.get("title");
  facts.scale = scale;
  facts.parameters = effective_parameters(p);
  check_label(facts.name, "study", file.string());
  return facts;
}

std::size_t sized_number(ParameterHandler& p, const std::string& key, const std::string& scale) {
  const auto usual = static_cast<std::size_t>(p.get_integer(key));
  if (scale.empty()) return usual;
  const Subsection subsection(p, "scale " + scale);
  const auto sized = static_cast<std::size_t>(p.get_integer(key));
  return sized > 0 ? sized : usual;
}

}  // namespace smoothfem
