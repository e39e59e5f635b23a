// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "smoothing/base/input_error.h"
#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// Throws InputError unless all boundary nodes are fixed: energies of meshes with different
/// boundary values cannot be compared.
inline void require_fixed_boundary(const Topology& topology) {
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
    if (topology.on_boundary()[i] && !topology.is_fixed(i))
      throw InputError("node " + std::to_string(i) +
                       " of the boundary is not fixed, as solution-adaptive methods need it; "
                       "fix the boundary");
}

}  // namespace smoothfem
