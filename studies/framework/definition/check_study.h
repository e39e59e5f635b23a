// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "studies/framework/definition/study.h"

namespace smoothfem {

/// Throws InputError if there are no labels, if one occurs twice, or if one has letters that file
/// names may not have. what: the labelled things.
void check_labels(std::vector<std::string> labels, const std::string& what,
                  const std::string& file);

/// Throws InputError if something that the study names does not exist. It runs before the first
/// mesh is generated. The message does not name the study file.
void check_study(const Study& study);

}  // namespace smoothfem
