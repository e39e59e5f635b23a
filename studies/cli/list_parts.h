// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "smoothing/loop/parameter.h"

namespace smoothfem {

/// The parts of `smoothfem list` in modules, found by their names when the module is loaded. what:
/// the folder of the studies, or the kind of the study keys.
extern "C" {
void smoothfem_list_studies(const std::string& what);
void smoothfem_list_study_keys(const std::string& what);
void smoothfem_list_domains(const std::string& what);
void smoothfem_list_solutions(const std::string& what);
void smoothfem_list_solvers(const std::string& what);
}

/// Prints a parameter with its range and the origin of its default. only_for: the kind of meshes,
/// if only one has the parameter.
void list_parameter(const Parameter& parameter, const std::string& origin, const char* only_for);

}  // namespace smoothfem
