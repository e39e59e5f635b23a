// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>

#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// A vector for each free node, in their order: n_free x dim.
using NodeVectors = Eigen::MatrixXd;

/// The graph Laplacian L of a mesh's free nodes: each has the number of its edges on the diagonal,
/// and -1 for each free neighbour. A gradient g in node positions becomes the movement L^-1 g, in
/// which neighbours go together: nodes alone would make their cells invalid long before the error
/// falls (Sobolev gradient). Depends on the topology alone; factorized once.
class NodeLaplacian {
 public:
  explicit NodeLaplacian(const Topology& topology);
  ~NodeLaplacian();

  NodeVectors solve(const NodeVectors& right_hand_side) const;

 private:
  struct Factorization;
  std::unique_ptr<Factorization> factorization_;
};

}  // namespace smoothfem
