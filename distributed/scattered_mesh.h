// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "distributed/node_directory.h"
#include "smoothing/mesh/compressed_rows.h"

namespace smoothfem {

/// Cells of a mesh that lie on the ranks in any way, each on one of them, and its nodes.
template <int dim>
struct ScatteredMesh {
  std::size_t n_cells = 0;                ///< of the whole mesh
  std::vector<GlobalIndex> cells{};       ///< numbers of this rank's cells, ascending
  CompressedRows<GlobalIndex> corners{};  ///< of these cells
  std::vector<int> tags{};                ///< of these cells
  /// Nodes: coordinates, and the reasons to stay that files say.
  NodeDirectory<NodeEntry<dim>> nodes;
  bool fixes_boundary = true;  ///< nodes on the boundary stay
};

}  // namespace smoothfem
