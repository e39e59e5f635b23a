// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/definition/included_files.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

#include "smoothing/base/input_error.h"
#include "smoothing/base/text.h"
#include "studies/framework/definition/study_file.h"

namespace smoothfem {

namespace fs = std::filesystem;

namespace {

/// Returns the text after `include` in a line; empty for all other lines.
std::string included_in(const std::string& line) {
  std::istringstream words(line.substr(0, line.find('#')));
  std::string first, path;
  if (!(words >> first) || first != "include") return "";
  std::getline(words >> std::ws, path);
  return path.substr(0, path.find_last_not_of(" \t\r") + 1);
}

/// Returns the content of an included file. position: position of the line that includes it.
std::string content_of(const fs::path& included, const std::string& position) {
  try {
    return read_study_text(included);
  } catch (const InputError&) {
    throw InputError(position + ": cannot read the file '" + included.string() +
                     "' that is included here; check its path");
  }
}

/// Files that include others twice grow without end.
constexpr std::size_t max_depth = 1000, max_lines = 10'000'000, max_includes = 10'000;

/// Returns the line with the group of 'set diffusivity group=NAME = FORMULA' as a part of the key,
/// which ends at the first '=' for deal.II. So do other keys of groups. Other lines are unchanged.
std::string with_group_in_key(const std::string& line) {
  const StudyLine read = study_line(line);
  if (read.kind != StudyLine::Kind::set || !read.name.ends_with(" group")) return line;
  const auto equals = read.value.find('=');
  const auto end = read.value.find_last_not_of(" \t", equals - 1);
  if (equals == std::string::npos || equals == 0 || end == std::string::npos) return line;
  return "set " + read.name + " " + read.value.substr(0, end + 1) + " " + read.value.substr(equals);
}

void require_utf8(const std::string& line, const std::string& position) {
  const std::string read = line.substr(0, line.find('#'));
  if (as_utf8(read) != read)
    throw InputError(position + ": the line is not UTF-8; save the file in UTF-8");
}

/// Throws InputError if a file includes itself, and for includes without end.
void require_end(const fs::path& included, const std::vector<fs::path>& including,
                 std::size_t n_includes, std::size_t n_lines, const std::string& position) {
  std::error_code ignored;
  if (std::any_of(including.begin(), including.end(),
                  [&](const fs::path& outer) { return fs::equivalent(outer, included, ignored); }))
    throw InputError(position + ": '" + included.string() +
                     "' is included here, and includes this file itself; take one of the lines "
                     "out");
  if (including.size() > max_depth || n_includes > max_includes || n_lines > max_lines)
    throw InputError(position + ": the study includes too many files (the limits are " +
                     std::to_string(max_includes) + " files, " + std::to_string(max_depth) +
                     " of them inside each other, and " + std::to_string(max_lines) +
                     " lines); include fewer");
}

}  // namespace

StudyText::StudyText(const fs::path& file) : file_(file) {
  add(read_study_text(file), {file});
}

StudyText StudyText::with_text(std::string text) const {
  StudyText other = *this;
  other.text_ = std::move(text);
  return other;
}

std::string StudyText::position(std::size_t line) const {
  return positions_.at(std::min(line, positions_.size()) - 1);
}

std::vector<std::string> StudyText::repetitions() const {
  std::vector<std::string> sentences;
  std::map<std::string, std::size_t> last_line;  // of a key, by the file and the subsections
  std::vector<std::string> sections{""};
  std::istringstream lines(text_);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    const StudyLine read = study_line(line);
    const std::string at = position(++number);
    if (read.kind == StudyLine::Kind::subsection)
      sections.push_back(sections.back() + read.name + "/");
    if (read.kind == StudyLine::Kind::end && sections.size() > 1) sections.pop_back();
    if (read.kind != StudyLine::Kind::set) continue;
    const std::string key = sections.back() + read.name;
    const auto [earlier, is_first] =
        last_line.try_emplace(at.substr(0, at.rfind(':')) + ":" + key, number);
    if (!is_first)
      sentences.push_back(at + ": '" + key +
                          "' is set a second time; this value counts, not that of " +
                          position(std::exchange(earlier->second, number)));
  }
  return sentences;
}

void StudyText::add(const std::string& text, const std::vector<fs::path>& including) {
  const fs::path& file = including.back();
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string position = file.string() + ":" + std::to_string(++number);
    const std::string name = included_in(line);
    if (name.empty()) {
      require_utf8(line, position);
      text_ += with_group_in_key(line) + "\n";
      positions_.push_back(position);
      continue;
    }
    const fs::path included = file.parent_path() / name;
    included_.push_back(included);
    require_end(included, including, included_.size(), positions_.size(), position);
    std::vector<fs::path> further = including;
    further.push_back(included);
    add(content_of(included, position), further);
  }
}

}  // namespace smoothfem
