// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "studies/framework/definition/study.h"

namespace smoothfem {

/// Fills StudyMethod::files and StudyMethod::version: programs, scripts and plugins that methods
/// come from, as they are now. What is not there is left out; the method will fail, and say so.
void note_files(Study& study);

}  // namespace smoothfem
