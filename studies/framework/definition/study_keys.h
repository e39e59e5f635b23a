// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "smoothing/mesh/mesh.h"
#include "studies/framework/definition/study.h"
#include "studies/framework/definition/study_file.h"

namespace smoothfem {

/// Declare the keys of a study file: the lists that say which subsections there are, the subsection
/// of one mesh, that of one method for meshes of these dimensions (its parameters only if the type
/// is known: not empty; the preset may be empty; a method in a file is looked for in the folder),
/// the problem.
void declare_lists(dealii::ParameterHandler& p);
void declare_mesh(dealii::ParameterHandler& p, int dimension, const std::string& name);
void declare_method(dealii::ParameterHandler& p, MeshDimensions dimensions, const std::string& name,
                    const std::string& type, const std::string& preset = {},
                    const std::filesystem::path& folder = {});
void declare_problem(dealii::ParameterHandler& p);

/// Declares the subsection of one of several solutions. formula_help: what its formula may have.
void declare_solution(dealii::ParameterHandler& p, const std::string& name,
                      const std::string& formula_help);
/// Reads it: the solution that it describes, or one of the program's by the subsection's name.
/// Throws InputError if it says both.
StudySolution read_solution(dealii::ParameterHandler& p, const std::string& name);

/// Declares what one scale changes.
void declare_scale(dealii::ParameterHandler& p, const std::string& name);

/// For declare_solution, in studies of the kind smoothing.
inline const std::string formula_of_solutions = "u as a formula, as in the subsection 'solution'.";

/// What a scale may change, for apply_scale.
inline const std::vector<std::string> scaled_numbers{"record every", "edge scale", "timing runs"};
inline const std::vector<std::string> scaled_lists{"record stages every", "meshes", "seeds"};

}  // namespace smoothfem
