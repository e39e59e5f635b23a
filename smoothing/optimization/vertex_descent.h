// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/mesh.h"
#include "smoothing/optimization/disjoint_groups.h"
#include "smoothing/optimization/sliding_nodes.h"

namespace smoothfem {

/// Minimizes the shape objective (shape_objective.h) node after node: each free node in turn takes
/// a Newton step for the cells it belongs to, in which its position is the minimum of a convex
/// function as long as they are valid, shortened until that falls; nodes that slide take it in the
/// directions in which they may go, and from there to the nearest point of their part of the
/// boundary. Several threads take parts of
/// the mesh at a time that do not touch each other; the result is the same for every number of
/// them.
template <int dim>
class VertexDescent {
 public:
  /// sliding: of the free nodes; null if all move freely. Both must outlive this.
  explicit VertexDescent(const Topology& topology, const SlidingNodes<dim>* sliding = nullptr);

  /// One sweep over the free nodes. x: of all nodes.
  void sweep(std::span<Point<dim>> x) const { sweep(x, 0.0, nullptr); }
  /// One sweep over the free nodes with a flag in `active` (one for each node).
  void sweep(std::span<Point<dim>> x, const std::vector<std::uint8_t>& active) const {
    sweep(x, 0.0, active.data());
  }

  /// The same for the objective that invalid cells have too
  /// (node_terms.h); softness: in terms of the mean |det(S)| of the node's corners.
  void soft_sweep(std::span<Point<dim>> x, double softness,
                  const std::vector<std::uint8_t>& active) const {
    sweep(x, softness, active.data());
  }

 private:
  void sweep(std::span<Point<dim>> x, double softness, const std::uint8_t* active) const;

  const Topology& topology_;
  const SlidingNodes<dim>* sliding_;
  std::vector<IndexRange> parts_;  ///< of topology.free_nodes()
  DisjointGroups groups_;
};

}  // namespace smoothfem
