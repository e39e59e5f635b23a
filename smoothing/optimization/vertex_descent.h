// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/mesh.h"
#include "smoothing/mesh/node_constraints.h"
#include "smoothing/optimization/disjoint_groups.h"

namespace smoothfem {

/// Minimizes the shape objective (shape_objective.h) node after node. Each free node in turn makes
/// a Newton step for its cells, shortened until their objective falls. As long as these cells are
/// valid, the objective is a convex function of the node's position. Nodes with constraints step in
/// the directions in which they may move, and then go to the nearest point of their part of the
/// surface. Several threads process parts of the mesh that do not touch each other. The result is
/// the same for every number of threads.
template <int dim>
class VertexDescent {
 public:
  /// constraints: of free nodes; null if all move freely. topology and constraints must outlive
  /// this.
  explicit VertexDescent(const Topology& topology,
                         const NodeConstraints<dim>* constraints = nullptr);

  /// Makes one sweep over the free nodes. x: coordinates of all nodes.
  void sweep(std::span<Point<dim>> x) const { sweep(x, 0.0, nullptr); }
  /// Makes one sweep over the free nodes with a flag in `active` (one for each node).
  void sweep(std::span<Point<dim>> x, const std::vector<std::uint8_t>& active) const {
    sweep(x, 0.0, active.data());
  }

  /// Makes one sweep for the softened objective, which is finite for invalid cells, too
  /// (node_terms.h). softness: relative to the mean |det(S)| of the node's corners.
  void soft_sweep(std::span<Point<dim>> x, double softness,
                  const std::vector<std::uint8_t>& active) const {
    sweep(x, softness, active.data());
  }

 private:
  void sweep(std::span<Point<dim>> x, double softness, const std::uint8_t* active) const;

  const Topology& topology_;
  const NodeConstraints<dim>* constraints_;
  std::vector<IndexRange> parts_;  ///< parts of topology.free_nodes()
  DisjointGroups groups_;
};

}  // namespace smoothfem
