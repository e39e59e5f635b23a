// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "distributed/scattered_mesh.h"
#include "smoothing/mesh/mesh.h"
#include "smoothing/parts/mesh_part.h"

namespace smoothfem {

/// A mesh of which each rank holds a part (mesh_part.h).
template <int dim>
struct DistributedMesh {
  Mesh<dim> part;
  std::size_t n_nodes = 0;       ///< of the whole mesh
  std::size_t n_neighbours = 0;  ///< ranks that own nodes which the part has copied
  /// The nodes of the whole mesh; their coordinates are those before smoothing until
  /// store_coordinates().
  NodeDirectory<NodeEntry<dim>> directory;
};

/// Makes the parts of a mesh. Nodes stay on the boundary, if the mesh says so, between cells of
/// different materials, and for the reasons in the directory. Throws InputError on all ranks for
/// cells that are no mesh. Collective.
template <int dim>
DistributedMesh<dim> distribute(const Ranks& ranks, ScatteredMesh<dim> mesh);

/// Writes the coordinates of all nodes to the directory, from where any rank can ask for them, and
/// the reasons to stay. Collective.
template <int dim>
void store_coordinates(DistributedMesh<dim>& mesh);

}  // namespace smoothfem
