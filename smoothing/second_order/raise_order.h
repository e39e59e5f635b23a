// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Elements of second order with the same corners.
enum class SecondOrderKind {
  complete,    ///< TRI6, QUAD9, TET10, PYRAMID14, PRISM18, HEX27
  serendipity  ///< TRI6, QUAD8, TET10, PYRAMID13, PRISM15, HEX20: nodes on edges only
};

/// Returns a linear mesh with midside nodes at their straight places, numbered after its nodes: by
/// cell, and in a cell in the order of midside_nodes.h. Labelled facets get them, too; numbers of
/// nodes and what else a file says are left out. Throws InputError for polygons with five or more
/// nodes, and meshes that have midside nodes already.
template <int dim>
Mesh<dim> with_midside_nodes(const Mesh<dim>& mesh,
                             SecondOrderKind kind = SecondOrderKind::complete);

/// Returns the mesh of the corners of one of second order, with the same numbers: no cell uses its
/// midside nodes.
template <int dim, int spacedim>
Mesh<dim, spacedim> with_linear_cells(const Mesh<dim, spacedim>& mesh) {
  return {mesh.topology().without_midside(), mesh.copied_coordinates(), mesh.shared_constraints(),
          mesh.shared_targets()};
}

}  // namespace smoothfem
