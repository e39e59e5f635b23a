// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/framework/definition/study_file.h"

namespace smoothfem {

/// Keys that a collection has besides those of a study of smoothing methods; the same keys in the
/// subsection of a scale take the place of these values there.
inline const std::vector<std::string> collection_lists{
    "collection", "domains", "elements", "sizes", "distortions", "seeds", "solutions"};

/// Declares them, the lists of solutions' subsections and scales too.
void declare_collection(dealii::ParameterHandler& p);
void declare_collection_scale(dealii::ParameterHandler& p, const std::string& scale);
void declare_collection_solution(dealii::ParameterHandler& p, const std::string& name);

/// The text of a collection without its own keys, as many lines as before: what a reader of
/// smoothing studies takes. solutions: names of subsections that belong to the collection.
StudyText without_collection_keys(const StudyText& text, const std::vector<std::string>& solutions);

}  // namespace smoothfem
