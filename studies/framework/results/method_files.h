// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "studies/framework/definition/study.h"

namespace smoothfem {

/// Fills StudyMethod::files and StudyMethod::version with the present programs, scripts and plugins
/// of the methods. Missing files are left out; the method will fail and report them.
void note_files(Study& study);

}  // namespace smoothfem
