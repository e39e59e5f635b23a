// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "studies/framework/run/study_options.h"
#include "studies/kinds/collection/collection.h"

namespace smoothfem {

/// Runs the members of a collection, or one shard of them, each in its own folder
/// members/MEMBER: all initial meshes, on several processes; then smoothing, one member after the
/// other with nothing else of ours running on its machine; then finite elements, on several
/// processes; smaller meshes first. The processes are those of a TaskTeam. Then writes the tables
/// of all. A member that cannot be used, or whose process dies, is a row in members.csv with the
/// reason. A run that is killed goes on where it was, and tries again what has failed; a complete
/// one with the same members is left as it is. Throws InputError for a folder that cannot be
/// written, results of other parameters in it, and --mesh-dir.
void run_collection(const Collection& collection, const StudyOptions& options);

}  // namespace smoothfem
