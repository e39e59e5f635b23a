// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "studies/framework/definition/study_file.h"
#include "studies/kinds/collection/collection.h"

namespace smoothfem {

/// The members that the keys of a collection name, sorted by name: files matching its patterns
/// (relative to the folder), and domains x elements x sizes x distortions x seeds, each with every
/// solution. Throws InputError if there are none, for names that are not known, and if two would
/// have one name.
std::vector<Member> expand_members(dealii::ParameterHandler& p,
                                   const std::filesystem::path& folder);

}  // namespace smoothfem
