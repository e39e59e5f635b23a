// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/framework/definition/study_file.h"

namespace smoothfem {

/// Keys that a collection has in addition to those of a study of smoothing methods. The subsection
/// of a scale may set other values for them.
inline const std::vector<std::string> collection_lists{"collection",  "domains", "elements",
                                                       "algorithms",  "eps",     "sizes",
                                                       "distortions", "seeds",   "solutions"};

/// Declares these keys, and the lists of the subsections of solutions and scales.
void declare_collection(dealii::ParameterHandler& p);
void declare_collection_scale(dealii::ParameterHandler& p, const std::string& scale);
void declare_collection_solution(dealii::ParameterHandler& p, const std::string& name);

/// Returns the text of a collection without its own keys, for a reader of smoothing studies. It has
/// the same number of lines. solutions: names of subsections that belong to the collection.
StudyText without_collection_keys(const StudyText& text, const std::vector<std::string>& solutions);

}  // namespace smoothfem
