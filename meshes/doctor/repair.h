// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "meshes/io/mesh_assembly.h"

namespace smoothfem {

/// Makes the changes that the options ask for, before a mesh is made. Changes nothing if nothing is
/// wrong. Leaves cells that Topology refuses as they are. Returns one sentence for each change.
std::vector<std::string> repair_while_reading(MeshParts& parts, const MeshReadOptions& options);

/// Removes doubled cells, merges coincident nodes, removes nodes without cells, and turns over
/// cells whose only fault is the direction of their nodes. Returns one sentence for each change.
/// Throws InputError as examine() does.
std::vector<std::string> repair(MeshParts& parts);

}  // namespace smoothfem
