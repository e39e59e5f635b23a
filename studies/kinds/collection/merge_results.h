// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

namespace smoothfem {

/// Merges results folders of one collection, from several shards or machines, into a new folder as
/// if one run had made it. A member that several folders have is taken from the first one in which
/// it is complete.
/// Throws InputError, after it has written the folder, if members are missing or not complete: the
/// message names some of them, and their shards. The next run of the study makes them.
/// Throws InputError for folders without results of a collection, for folders with different
/// parameters, and if `out` exists. It leaves nothing half written.
void merge_results(const std::vector<std::filesystem::path>& folders,
                   const std::filesystem::path& out);

}  // namespace smoothfem
