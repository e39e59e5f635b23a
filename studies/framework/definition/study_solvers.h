// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

#include "studies/framework/definition/study.h"
#include "studies/framework/definition/study_file.h"

namespace smoothfem {

/// Declares the subsections 'solver LABEL' of all solvers of the list but Poisson's, with the
/// parameters of their types. dimension: of the meshes. has_plugins: the study names plugins, which
/// may have the types that are not known.
void declare_solvers(dealii::ParameterHandler& p, const StudyText& text,
                     const std::vector<std::string>& labels, int dimension, bool has_plugins);

/// Reads these subsections. Solvers with degrees have those of the study unless they name others.
/// Throws InputError for values that a solver does not take.
std::vector<StudySolver> read_solvers(dealii::ParameterHandler& p, const StudyText& text,
                                      const std::vector<std::string>& labels, int dimension,
                                      const std::vector<int>& degrees);

}  // namespace smoothfem
