// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace smoothfem {

/// "key = value" lines of a study file, subsections as prefix: "scale quick/edge scale".
using StudyParameters = std::vector<std::pair<std::string, std::string>>;

/// What studies of all kinds have, and results say about them.
struct StudyHeader {
  std::string name;
  std::string title;
  std::string note;       ///< what can be compared with the literature, in one sentence, or empty
  std::string scale;      ///< the one chosen; empty: as the study file says
  bool built_in = false;  ///< the study file is, to the letter, one that comes with the program
  StudyParameters parameters;  ///< in force: with what the scale changes
  /// As the file says: with the scale's name, what an earlier run that is to go on must have had.
  StudyParameters file_parameters;
};

}  // namespace smoothfem
