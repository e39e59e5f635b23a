// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "smoothing/base/input_error.h"
#include "studies/framework/definition/included_files.h"

namespace smoothfem {

/// How deal.II is told to call the study file in its messages; the path itself could hold anything.
inline constexpr const char* study_file_in_messages = "this file";

/// What deal.II says about a study file that it cannot read, in the words of this program: file and
/// line, what is wrong there, and what would be right.
/// text: what was read. message: what() of deal.II's exception. keys: all that the file may set,
/// subsections before a slash: "mesh gear/domain".
InputError parse_error(const StudyText& text, const std::string& message,
                       const std::vector<std::string>& keys);

}  // namespace smoothfem
