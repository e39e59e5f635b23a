// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "meshes/doctor/examinations/facet_table.h"

namespace smoothfem {

/// A node inside a boundary facet, or inside an edge of it, of a cell that does not have the node.
struct HangingNode {
  NodeIndex node;
  std::uint32_t facet;  ///< of the skin
};

/// Returns all hanging nodes, ascending; each once. Such a node is nearer to the facet than 1e-6 of
/// the mesh's size and 1e-3 of the facet's shortest edge. These bounds allow for files with six
/// digits. A warped face counts as bilinear.
std::vector<HangingNode> find_hanging_nodes(const PlainCells& cells, const Skin& skin);

/// Boundary nodes in one place, which belong to different cells.
struct CoincidentNodes {
  /// For each node the first one in its place, often itself; empty if no nodes coincide.
  std::vector<NodeIndex> first;
  std::size_t count = 0;     ///< nodes that are not the first ones in their places
  std::size_t n_joined = 0;  ///< pairs of facets that become one if the nodes do

  bool is_first(NodeIndex node) const { return first.empty() || first[node] == node; }
};

/// Finds the boundary nodes whose distance is below 1e-9 of the mesh's size and 1e-3 of the
/// shortest edge of the boundary there. Nodes of one cell do not count.
CoincidentNodes find_coincident_nodes(const PlainCells& cells, const Skin& skin);

/// Returns flags of the hanging nodes, the corners of the facets in which they lie, and the
/// coincident nodes.
std::vector<bool> seam_flags(const PlainCells& cells, const Skin& skin,
                             const std::vector<HangingNode>& hanging,
                             const CoincidentNodes& coincident);

/// Returns the diagonal of the box around the nodes of the skin.
double size_of(const PlainCells& cells, const Skin& skin);

}  // namespace smoothfem
