// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace smoothfem {

/// One pair of parameters: the domain that classify() says, and that found by iteration.
struct ClassificationRow {
  std::size_t n;
  double theta, lambda;
  std::string predicted, iterated;  ///< "D_k" or "S_k"
  double predicted_growth, iterated_growth;
  bool agree() const { return predicted == iterated; }
};

/// What a random n-gon becomes in 2^doublings scaled steps, told from the polygon alone: D_0 if it
/// shrinks to its centroid, otherwise by the angle about which each node is turned against the one
/// before it. The matrix of the transformation is squared, so that also parameters very near to an
/// intersection line are decided.
ClassificationRow classify_by_iteration(std::size_t n, double theta, double lambda, int doublings,
                                        std::uint64_t seed);

}  // namespace smoothfem
