// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/optimization/sliding_nodes.h"

namespace smoothfem {

/// One Newton step of a node that slides on the boundary, halved until the objective of its cells
/// falls enough. No step is longer than its distance from its neighbours: beyond them the nearest
/// point of the boundary may be on another sheet of it. softness: as of VertexDescent::sweep.
template <int dim>
void slide_node(const Topology& topology, const SlidingNodes<dim>& sliding, NodeIndex node,
                double softness, std::span<Point<dim>> x);

}  // namespace smoothfem
