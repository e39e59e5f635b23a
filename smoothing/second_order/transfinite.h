// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace smoothfem {

/// Weights of the means of an element's corners, of its edges' nodes and of its faces' nodes.
struct TransfiniteWeights {
  double corners, edges = 0.0, faces = 0.0;
};

/// Returns the weights that give the node in the middle of an edge, a face or a hexahedron from the
/// nodes around it: transfinite interpolation (Gordon and Hall 1973, doi 10.1007/BF01436298). In
/// triangles it is the value of the polynomial of degree 2. n_corners: 2, 3, 4 or 8.
constexpr TransfiniteWeights transfinite_weights(std::size_t n_corners) {
  switch (n_corners) {
    case 2:
      return {1.0};
    case 3:
      return {-1.0 / 3.0, 4.0 / 3.0};
    case 4:
      return {-1.0, 2.0};
    default:
      return {1.0, -3.0, 3.0};
  }
}

}  // namespace smoothfem
