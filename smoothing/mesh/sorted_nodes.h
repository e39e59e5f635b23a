// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "smoothing/mesh/point.h"

namespace smoothfem {

/// Returns the nodes of an element in ascending order, by which it is known.
inline std::vector<NodeIndex> sorted_nodes(std::span<const NodeIndex> nodes) {
  std::vector<NodeIndex> result(nodes.begin(), nodes.end());
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace smoothfem
