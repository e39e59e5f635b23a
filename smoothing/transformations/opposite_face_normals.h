// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cassert>
#include <span>

#include "smoothing/simd/inverse_root.h"
#include "smoothing/simd/vectors.h"

namespace smoothfem {

/// The regularizing transformation of tetrahedra by opposite face normals (thesis, Definition 3.3):
/// p'_i = p_i + sigma n_i / sqrt(|n_i|). n_i is the normal of the face opposite to node i, directed
/// to the node. It commutes with similarities, enlarges, and moves the centroid. Iterating it makes
/// any tetrahedron regular, also an invalid one.
class OppositeFaceNormals {
 public:
  /// nodes, result: 4 points each, not overlapping. sigma >= 0, one for each lane. A face without
  /// area moves nothing.
  template <class Real>
  static inline void apply(Real sigma, std::span<const Vector3<Real>, 4> nodes,
                           std::span<Vector3<Real>, 4> result) {
    const auto &p1 = nodes[0], &p2 = nodes[1], &p3 = nodes[2], &p4 = nodes[3];
    // Edges are those of the cell's table, so that compilers compute them once.
    result[0] = p1 + scaled(sigma, cross(p4 - p2, p3 - p2));
    result[1] = p2 + scaled(sigma, cross(p3 - p1, p4 - p3));
    result[2] = p3 + scaled(sigma, cross(p4 - p2, p4 - p1));
    result[3] = p4 + scaled(sigma, cross(p2 - p1, p3 - p1));
  }

  /// sigma n / sqrt(|n|).
  template <class Real>
  static inline Vector3<Real> scaled(Real sigma, Vector3<Real> normal) {
    const Real square = squared_length(normal);
    const Real root = square_root(square_root(square));
    return (square > 0.0 ? sigma / root : Real{}) * normal;
  }
};

}  // namespace smoothfem
