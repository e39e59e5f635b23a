// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "distributed/cell_table.h"
#include "distributed/node_directory.h"

namespace smoothfem {

/// What a mesh is read for. An examination needs the numbers of the file, and nodes that no element
/// uses.
enum class ReadFor { smoothing, examination };

/// Cells of a mesh that lie on the ranks in any way, each on one of them, and its nodes.
template <int dim>
struct ScatteredMesh {
  std::size_t n_cells = 0;  ///< of the whole mesh
  CellTable cells{};        ///< of this rank
  /// Nodes: coordinates, and the reasons to stay that files say.
  NodeDirectory<NodeEntry<dim>> nodes;
  bool fixes_boundary = true;  ///< nodes on the boundary stay
  bool is_compact = true;      ///< cells of a rank lie together, so that they may stay on it
  bool joins_places = false;   ///< nodes of equal coordinates have become one
  /// The file's numbers of nodes and cells, for an examination; empty if these are the numbers in
  /// the whole mesh.
  std::optional<NodeDirectory<std::size_t>> node_ids{}, cell_ids{};
};

}  // namespace smoothfem
