// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/definition/included_files.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "smoothing/base/input_error.h"
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

void StudyText::add(const std::string& text, const std::vector<fs::path>& including) {
  const fs::path& file = including.back();
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string position = file.string() + ":" + std::to_string(++number);
    const std::string name = included_in(line);
    if (name.empty()) {
      text_ += line + "\n";
      positions_.push_back(position);
      continue;
    }
    const fs::path included = file.parent_path() / name;
    std::error_code ignored;
    if (std::any_of(including.begin(), including.end(), [&](const fs::path& outer) {
          return fs::equivalent(outer, included, ignored);
        }))
      throw InputError(position + ": '" + included.string() +
                       "' is included here, and includes this file itself; take one of the lines "
                       "out");
    std::vector<fs::path> further = including;
    further.push_back(included);
    add(content_of(included, position), further);
  }
}

}  // namespace smoothfem
