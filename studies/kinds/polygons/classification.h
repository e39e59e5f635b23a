// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace smoothfem {

/// One pair of parameters, with the domain from classify() and the domain found by iteration.
struct ClassificationRow {
  std::size_t n;
  double theta, lambda;
  std::string predicted, iterated;  ///< "D_k" or "S_k"
  double predicted_growth, iterated_growth;
  bool agree() const { return predicted == iterated; }
};

/// Classifies the limit of a random n-gon after 2^doublings scaled steps, from the polygon alone.
/// It is D_0 if the polygon shrinks to its centroid. Otherwise the angle by which each node is
/// turned against the one before it decides.
/// The matrix of the transformation is squared repeatedly, so that parameters very near to an
/// intersection line are decided, too.
ClassificationRow classify_by_iteration(std::size_t n, double theta, double lambda, int doublings,
                                        std::uint64_t seed);

}  // namespace smoothfem
