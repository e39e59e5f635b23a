// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/periodic/periodic_maps.h"

namespace smoothfem {

/// A periodic mesh with copies of the cells at each periodic part of its boundary, placed at the
/// partner. So periodic nodes are inner nodes, as on a torus. The first nodes and cells are those
/// of the mesh; the rest are copies.
template <int dim>
struct Halo {
  /// A node that copies another one.
  struct Copy {
    NodeIndex node;  ///< of the mesh
    RigidMotion<dim> motion;
  };
  CompressedRows<NodeIndex> cells;
  std::vector<CellIndex> originals;  ///< the mesh's cell that each cell is or copies
  std::vector<Copy> copies;          ///< node n_nodes + k is a copy

  /// Returns the coordinates of all nodes. x: of those of the mesh.
  std::vector<Point<dim>> coordinates(std::span<const Point<dim>> x) const;
};

/// n_layers: layers of cells to copy, at least 1.
template <int dim>
Halo<dim> make_halo(const Mesh<dim>& mesh, const std::vector<PeriodicMap<dim>>& maps, int n_layers);

}  // namespace smoothfem
