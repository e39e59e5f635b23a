// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace smoothfem {

/// Pairs of key and value of a study file. Subsections are a prefix: "scale quick/edge scale".
using StudyParameters = std::vector<std::pair<std::string, std::string>>;

/// The data that studies of all kinds have, and that results report.
struct StudyHeader {
  std::string name;
  std::string title;
  std::string note;       ///< what can be compared with the literature, in one sentence, or empty
  std::string scale;      ///< the chosen scale; empty: no scale
  bool built_in = false;  ///< the study file is an unchanged one that comes with the program
  StudyParameters parameters;  ///< in force: with the scale's changes
  /// Parameters as in the file, without the scale's changes. To resume an earlier run, these and
  /// the scale must match.
  StudyParameters file_parameters;
};

}  // namespace smoothfem
