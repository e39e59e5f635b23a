// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "smoothing/mesh/mesh.h"
#include "studies/framework/definition/study_file.h"

namespace smoothfem {

/// Declare the keys of a study file: the lists that say which subsections there are, the subsection
/// of one mesh, that of one method for meshes of these dimensions (its parameters only if the type
/// is known: not empty; the preset may be empty; a method in a file is looked for in the folder),
/// the problem, and what one scale changes.
void declare_lists(dealii::ParameterHandler& p);
void declare_mesh(dealii::ParameterHandler& p, int dimension, const std::string& name);
void declare_method(dealii::ParameterHandler& p, MeshDimensions dimensions, const std::string& name,
                    const std::string& type, const std::string& preset = {},
                    const std::filesystem::path& folder = {});
void declare_problem(dealii::ParameterHandler& p);
void declare_scale(dealii::ParameterHandler& p, const std::string& name);

/// What a scale may change, for apply_scale.
inline const std::vector<std::string> scaled_numbers{"record every", "edge scale", "timing runs"};
inline const std::vector<std::string> scaled_lists{"record stages every", "meshes", "seeds"};

}  // namespace smoothfem
