// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "studies/framework/definition/study_file.h"
#include "studies/kinds/collection/collection.h"

namespace smoothfem {

/// Returns the members that the keys of a collection describe, sorted by name: files that match its
/// patterns (relative to the folder), and domains x elements x sizes x distortions x seeds. Each
/// occurs with every solution.
/// Throws InputError if there are no members, for unknown names, and if two members would have the
/// same name.
std::vector<Member> expand_members(dealii::ParameterHandler& p,
                                   const std::filesystem::path& folder);

}  // namespace smoothfem
