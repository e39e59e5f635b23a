// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "studies/framework/definition/study.h"

namespace smoothfem {

/// Throws InputError unless there are labels, each once and of letters that names of files may
/// have. what: of what they are labels.
void check_labels(std::vector<std::string> labels, const std::string& what,
                  const std::string& file);

/// Whether what the study names is there: better now than after the first mesh is generated. Throws
/// InputError, which does not say the file.
void check_study(const Study& study);

}  // namespace smoothfem
