// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "studies/framework/definition/study_file.h"
#include "studies/kinds/collection/definition/collection.h"

namespace smoothfem {

/// Returns the members that the keys of a collection describe, sorted by name: files that match its
/// patterns (relative to the folder) x distortions x seeds, and domains x elements x sizes x
/// distortions x seeds. Each occurs with every solution.
/// Throws InputError if there are no members, for unknown names, and if two members would have the
/// same name.
std::vector<Member> expand_members(dealii::ParameterHandler& p,
                                   const std::filesystem::path& folder);

/// Returns lines for users: how many members come from mesh files and from each domain, with their
/// distortions, seeds and solutions.
std::string origins_of(const std::vector<const Member*>& members);

/// Returns sentences about keys that the study sets and that change no member.
std::vector<std::string> unused_keys(const std::vector<Member>& members, std::size_t n_seeds);

}  // namespace smoothfem
