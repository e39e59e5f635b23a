// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "smoothing/mesh/mesh.h"
#include "smoothing/parts/mesh_part.h"

namespace smoothfem {

/// Gives the nodes that a part of a mesh has copied the coordinates that their owners have.
/// Collective; nothing happens in a whole mesh.
template <int dim, int spacedim>
void update_copies(Mesh<dim, spacedim>& mesh) {
  if (const MeshPart* part = mesh.topology().part())
    part->update({mesh.coordinates().data()->data(), spacedim * mesh.n_nodes()}, spacedim);
}

/// Does the same; returns the nodes whose coordinates have changed.
template <int dim, int spacedim>
std::vector<NodeIndex> changed_copies(Mesh<dim, spacedim>& mesh) {
  std::vector<NodeIndex> changed;
  if (mesh.topology().part() == nullptr) return changed;
  const auto before = mesh.copied_coordinates();
  update_copies(mesh);
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    if (mesh.coordinates()[i] != before[i]) changed.push_back(i);
  return changed;
}

/// True if this holds in any part of a mesh. Collective.
inline bool holds_anywhere(const Topology& topology, bool holds) {
  return topology.part() ? topology.part()->any(holds) : holds;
}

/// Returns the number of some nodes of the whole mesh, from those of each part. Collective.
inline std::size_t count_in_whole(const Topology& topology, std::span<const NodeIndex> nodes) {
  const MeshPart* const part = topology.part();
  if (part == nullptr) return nodes.size();
  std::size_t n = 0;
  for (const NodeIndex i : nodes) n += part->owns_node(i) ? 1 : 0;
  return part->sum(n);
}

}  // namespace smoothfem
