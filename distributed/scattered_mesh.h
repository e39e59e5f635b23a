// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "distributed/cell_table.h"
#include "distributed/node_directory.h"

namespace smoothfem {

/// Cells of a mesh that lie on the ranks in any way, each on one of them, and its nodes.
template <int dim>
struct ScatteredMesh {
  std::size_t n_cells = 0;  ///< of the whole mesh
  CellTable cells{};        ///< of this rank
  /// Nodes: coordinates, and the reasons to stay that files say.
  NodeDirectory<NodeEntry<dim>> nodes;
  bool fixes_boundary = true;  ///< nodes on the boundary stay
  bool is_compact = true;      ///< cells of a rank lie together, so that they may stay on it
};

}  // namespace smoothfem
