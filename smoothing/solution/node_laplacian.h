// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// A vector for each moving node, in their order: n_nodes x dim.
using NodeVectors = Eigen::MatrixXd;

/// The graph Laplacian L of the moving nodes of a mesh. Its diagonal has each node's number of
/// edges; each moving neighbour has -1. A gradient g in node positions becomes the movement L^-1 g,
/// in which neighbours move together (Sobolev gradient). Nodes that move alone would make their
/// cells invalid long before the error falls. Depends on the topology alone; factorized once.
class NodeLaplacian {
 public:
  /// nodes: ascending.
  NodeLaplacian(const Topology& topology, const std::vector<NodeIndex>& nodes);
  ~NodeLaplacian();

  NodeVectors solve(const NodeVectors& right_hand_side) const;

 private:
  struct Factorization;
  std::unique_ptr<Factorization> factorization_;
};

}  // namespace smoothfem
