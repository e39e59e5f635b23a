// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/loop/problem.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// The nodes that a method moves by a solution: the free ones and, where nodes may slide on the
/// boundary, those of its straight lines and plane faces, along these. The domain stays what it is:
/// corners stay, and so do all nodes of a boundary that is curved, those between parts of different
/// tags, and fixed nodes inside.
template <int dim>
class MovableNodes {
 public:
  MovableNodes() = default;
  /// mesh: with the boundary on which nodes slide.
  MovableNodes(const Mesh<dim>& mesh, bool boundary_slides);

  /// Ascending.
  const std::vector<NodeIndex>& nodes() const { return nodes_; }
  bool contains(NodeIndex node) const { return contains_[node] != 0; }

  /// What a node follows of a movement: all of it inside, its part along the boundary there.
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
