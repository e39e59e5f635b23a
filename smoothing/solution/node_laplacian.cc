// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/solution/node_laplacian.h"

#include <Eigen/SparseCholesky>
#include <vector>

namespace smoothfem {

namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// The lower triangle, which is all that the factorization looks at.
Matrix graph_laplacian(const Topology& topology) {
  // Keeps the matrix positive definite where free nodes have no way to a fixed one.
  constexpr double shift = 1e-9;
  const auto& free_nodes = topology.free_nodes();
  std::vector<int> number(topology.n_nodes(), -1);
  for (std::size_t k = 0; k < free_nodes.size(); ++k) number[free_nodes[k]] = static_cast<int>(k);
  std::vector<Eigen::Triplet<double>> entries;
  for (const NodeIndex i : free_nodes) {
    const auto neighbours = topology.node_neighbours(i);
    entries.emplace_back(number[i], number[i],
                         (1.0 + shift) * static_cast<double>(neighbours.size()));
    for (const NodeIndex j : neighbours)
      if (number[j] >= 0 && number[j] < number[i]) entries.emplace_back(number[i], number[j], -1.0);
  }
  const auto n = static_cast<Eigen::Index>(free_nodes.size());
  Matrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

struct NodeLaplacian::Factorization {
  Eigen::SimplicialLDLT<Matrix, Eigen::Lower> of_matrix;
};

NodeLaplacian::NodeLaplacian(const Topology& topology)
    : factorization_(std::make_unique<Factorization>()) {
  factorization_->of_matrix.compute(graph_laplacian(topology));
}

NodeLaplacian::~NodeLaplacian() = default;

NodeVectors NodeLaplacian::solve(const NodeVectors& right_hand_side) const {
  return factorization_->of_matrix.solve(right_hand_side);
}

}  // namespace smoothfem
