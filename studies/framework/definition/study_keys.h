// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "smoothing/mesh/mesh.h"
#include "studies/framework/definition/study.h"
#include "studies/framework/definition/study_file.h"

namespace smoothfem {

/// Each function declares a part of the keys of a study file. declare_lists: the lists that
/// determine which subsections exist. declare_mesh: the subsection of one mesh. declare_problem:
/// the problem.
/// declare_method: the subsection of one method for meshes of these dimensions. An empty type
/// declares no parameters. The preset may be empty. A method in a file is searched in the folder.
void declare_lists(dealii::ParameterHandler& p);
void declare_mesh(dealii::ParameterHandler& p, int dimension, const std::string& name);
void declare_method(dealii::ParameterHandler& p, MeshDimensions dimensions, const std::string& name,
                    const std::string& type, const std::string& preset = {},
                    const std::filesystem::path& folder = {});
void declare_problem(dealii::ParameterHandler& p);

/// Declares the keys of the subsection 'finite elements', in the present subsection.
void declare_finite_elements(dealii::ParameterHandler& p);
/// Reads them. Degree, natural groups and ties are not among them.
PoissonOptions read_finite_elements(dealii::ParameterHandler& p);

/// Declares parameters with their defaults, ranges and descriptions.
void declare_parameters(dealii::ParameterHandler& p, const Parameters& parameters);

/// Declares the subsection of one of several solutions. formula_help: help text of its formula.
void declare_solution(dealii::ParameterHandler& p, const std::string& name,
                      const std::string& formula_help);
/// Declares the keys 'diffusivity group NAME' that the text has in subsections of solutions.
void declare_group_diffusivities(dealii::ParameterHandler& p, const StudyText& text);
/// Reads the keys 'diffusivity group NAME' of the subsection "solution" or "solution LABEL".
std::vector<GroupDiffusivity> read_group_diffusivities(dealii::ParameterHandler& p,
                                                       const std::string& section);
/// Reads that subsection: its formula, or the program's solution of its name. Throws InputError if
/// it has both.
StudySolution read_solution(dealii::ParameterHandler& p, const StudyText& text,
                            const std::string& name);

/// Declares the subsection of one scale.
void declare_scale(dealii::ParameterHandler& p, const std::string& name);

/// Help text for declare_solution, in studies of the kind smoothing.
inline const std::string formula_of_solutions = "u as a formula, as in the subsection 'solution'.";

/// Numbers that a scale may change, for apply_scale.
inline const std::vector<std::string> scaled_numbers{"record every", "edge scale", "timing runs",
                                                     "refine"};
inline const std::vector<std::string> scaled_lists{"record stages every",
                                                   "meshes",
                                                   "seeds",
                                                   "degrees",
                                                   "in parts",
                                                   "finite elements/condition number"};

}  // namespace smoothfem
