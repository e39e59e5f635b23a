// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "smoothing/base/input_error.h"
#include "studies/framework/definition/included_files.h"

namespace smoothfem {

/// Name of the study file in deal.II's messages. The path itself could contain anything.
inline constexpr const char* study_file_in_messages = "this file";

/// Turns deal.II's message about a study file into this program's words: file and line, the error,
/// and the correct form.
/// text: the text that was read. message: what() of deal.II's exception.
/// keys: all keys that the file may set, with subsections before a slash, for example "mesh
/// gear/domain".
InputError parse_error(const StudyText& text, const std::string& message,
                       const std::vector<std::string>& keys);

}  // namespace smoothfem
