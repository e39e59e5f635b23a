// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "studies/framework/definition/study.h"
#include "studies/framework/run/study_options.h"

namespace smoothfem {

/// Prints what a study would do: its meshes with their sizes (they are generated, but not
/// distorted), methods, records, and by rough rules how long it would take, in what memory, and
/// what it would write. Nothing is written. Throws InputError as run_study does before it writes.
void print_plan(const Study& study, const StudyOptions& options);

}  // namespace smoothfem
