// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/solution/node_laplacian.h"

#include <Eigen/SparseCholesky>

namespace smoothfem {

namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// Returns the lower triangle only: the factorization reads nothing else.
Matrix graph_laplacian(const Topology& topology, const std::vector<NodeIndex>& nodes) {
  // Keeps the matrix positive definite for nodes without a path to a node that stays.
  constexpr double shift = 1e-9;
  std::vector<int> number(topology.n_nodes(), -1);
  for (std::size_t k = 0; k < nodes.size(); ++k) number[nodes[k]] = static_cast<int>(k);
  std::vector<Eigen::Triplet<double>> entries;
  for (const NodeIndex i : nodes) {
    const auto neighbours = topology.node_neighbours(i);
    entries.emplace_back(number[i], number[i],
                         (1.0 + shift) * static_cast<double>(neighbours.size()));
    for (const NodeIndex j : neighbours)
      if (number[j] >= 0 && number[j] < number[i]) entries.emplace_back(number[i], number[j], -1.0);
  }
  const auto n = static_cast<Eigen::Index>(nodes.size());
  Matrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

struct NodeLaplacian::Factorization {
  Eigen::SimplicialLDLT<Matrix, Eigen::Lower> of_matrix;
};

NodeLaplacian::NodeLaplacian(const Topology& topology, const std::vector<NodeIndex>& nodes)
    : factorization_(std::make_unique<Factorization>()) {
  factorization_->of_matrix.compute(graph_laplacian(topology, nodes));
}

NodeLaplacian::~NodeLaplacian() = default;

NodeVectors NodeLaplacian::solve(const NodeVectors& right_hand_side) const {
  return factorization_->of_matrix.solve(right_hand_side);
}

}  // namespace smoothfem
