// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "studies/framework/definition/study.h"
#include "studies/framework/run/study_options.h"

namespace smoothfem {

/// Prints the plan of a study: meshes with sizes (generated, but not distorted), methods, records,
/// and output. Rough rules estimate the time and the memory. Nothing is written. Throws InputError
/// as run_study does before it writes.
void print_plan(const Study& study, const StudyOptions& options);

}  // namespace smoothfem
