// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/loop/problem.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// The nodes that a solution-adaptive method moves: the free ones and, if nodes may slide on the
/// boundary, those of its straight lines and plane faces, along these. The domain keeps its shape.
/// These nodes stay: corners, all nodes of a curved boundary, those between parts of different
/// tags, and fixed nodes inside.
template <int dim>
class MovableNodes {
 public:
  MovableNodes() = default;
  /// mesh: its boundary is the one on which nodes slide.
  MovableNodes(const Mesh<dim>& mesh, bool boundary_slides);

  /// Ascending.
  const std::vector<NodeIndex>& nodes() const { return nodes_; }
  bool contains(NodeIndex node) const { return contains_[node] != 0; }

  /// Returns the part of a movement that a node follows: all of it inside, its component along the
  /// boundary there.
  Point<dim> along(NodeIndex node, const Point<dim>& movement) const {
    return contains_[node] == slides ? Point<dim>(projections_[node] * movement) : movement;
  }

 private:
  enum : std::uint8_t { stays, moves, slides };

  std::vector<NodeIndex> nodes_;
  std::vector<std::uint8_t> contains_;
  std::vector<CellTensor<dim>> projections_;  ///< of each node; empty if none slides
};

}  // namespace smoothfem
