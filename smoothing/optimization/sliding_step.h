// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/mesh/node_constraints.h"

namespace smoothfem {

/// Makes one Newton step of a node that slides on the boundary, halved until the objective of its
/// cells falls enough. No step is longer than the node's distance from its neighbours: beyond them
/// the nearest point of the boundary may be on another sheet of it. softness: as in
/// VertexDescent::soft_sweep.
template <int dim>
void slide_node(const Topology& topology, const NodeConstraints<dim>& constraints, NodeIndex node,
                double softness, std::span<Point<dim>> x);

}  // namespace smoothfem
