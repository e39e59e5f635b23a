// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "studies/framework/run/study_options.h"
#include "studies/kinds/collection/definition/collection.h"

namespace smoothfem {

/// Runs the members of a collection, or one shard of them, each in its own folder members/MEMBER.
/// Smaller meshes come first.
/// There are three phases. Initial meshes are made by several processes. Members are then smoothed
/// one after the other, without other processes of smoothfem on the same machine. Then several
/// processes solve finite elements. The processes are those of a TaskTeam. The tables of all
/// members follow.
/// If a member cannot be used or its process dies, its row in members.csv has the reason. A killed
/// run resumes, and tries failed members again. A complete run with the same members is left
/// unchanged.
/// Throws InputError for a folder that cannot be written, for results with other parameters in it,
/// and for --mesh-dir.
void run_collection(const Collection& collection, const StudyOptions& options);

}  // namespace smoothfem
