// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <unordered_map>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// The nodes of Gmsh's current model in the order of their tags, which is the order of their
/// creation.
struct GmshNodes {
  std::vector<Point<3>> points;
  std::unordered_map<std::size_t, NodeIndex> numbers;  ///< by tag
};

/// Reads the nodes. Call it inside a GmshSession's run().
GmshNodes nodes_of_model();

}  // namespace smoothfem
