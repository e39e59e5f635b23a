// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/definition/included_files.h"

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace fs = std::filesystem;

StudyText::StudyText(const std::string& text, const fs::path& file) : file_(file.string()) {
  add(text, {file});
}

std::string StudyText::position(std::size_t line) const {
  return positions_.at(std::min(line, positions_.size()) - 1);
}

void StudyText::add(const std::string& text, const std::vector<fs::path>& including) {
  static const std::regex include("\\s*include\\s+(\\S.*?)\\s*(#.*)?");
  const fs::path& file = including.back();
  std::istringstream lines(text);
  std::smatch match;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string position = file.string() + ":" + std::to_string(++number);
    if (!std::regex_match(line, match, include)) {
      text_ += line + "\n";
      positions_.push_back(position);
      continue;
    }
    const fs::path included = file.parent_path() / match[1].str();
    std::ifstream stream(included);
    std::ostringstream content;
    content << stream.rdbuf();
    if (!stream || fs::is_directory(included))
      throw InputError(position + ": cannot read the file '" + included.string() +
                       "' that is included here; check its path");
    std::error_code ignored;
    if (std::any_of(including.begin(), including.end(), [&](const fs::path& outer) {
          return fs::equivalent(outer, included, ignored);
        }))
      throw InputError(position + ": '" + included.string() +
                       "' is included here, and includes this file itself; take one of the lines "
                       "out");
    std::vector<fs::path> further = including;
    further.push_back(included);
    add(content.str(), further);
  }
}

}  // namespace smoothfem
