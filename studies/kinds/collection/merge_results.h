// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

namespace smoothfem {

/// Puts results folders of one collection, of several shards or machines, together into a new one
/// that is as if one run had made it. A member that several have is taken where it is complete,
/// from the first of them. Throws InputError for folders without results of a collection, for those
/// of different parameters, and for an `out` that is there already; leaves nothing half written.
void merge_results(const std::vector<std::filesystem::path>& folders,
                   const std::filesystem::path& out);

}  // namespace smoothfem
