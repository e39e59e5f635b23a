// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <span>

#include "smoothing/mesh/volume_elements.h"
#include "smoothing/transformations/opposite_face_normals.h"

namespace smoothfem {

/// The regularizing transformation of tetrahedra, hexahedra, pyramids and prisms by their dual
/// elements (thesis, Definition 3.4). The means of the faces are the nodes of the dual element. The
/// normal n_k of its face k is erected on a base point b_k of that face: p'_k = b_k + sigma n_k /
/// sqrt(|n_k|). It commutes with similarities and keeps regular elements regular; it keeps the
/// centroid of hexahedra only (Lemma 3.2). Iterating it makes any element regular, also an invalid
/// one. Tetrahedra and hexahedra need sigma > 0; pyramids and prisms sigma <= 2, as they do not
/// converge for large sigma.
class DualElement {
 public:
  /// nodes, result: n = 4, 5, 6 or 8 points each, not overlapping. sigma > 0, one for each lane.
  template <class Real, std::size_t n>
  static inline void apply(Real sigma, std::span<const Vector3<Real>, n> nodes,
                           std::span<Vector3<Real>, n> result) {
    using Element = VolumeElement<n>;
    std::array<Vector3<Real>, Element::faces.size()> dual;
    unrolled<Element::faces.size()>([&](auto f) {
      constexpr LocalFace face = Element::faces[f];
      auto sum = nodes[face.nodes[0]] + nodes[face.nodes[1]] + nodes[face.nodes[2]];
      if (face.size == 4) sum = sum + nodes[face.nodes[3]];
      dual[f] = (face.size == 4 ? 0.25 : 1.0 / 3.0) * sum;
    });
    const Real tau = base_position<n>(sigma);
    std::array<Vector3<Real>, 4> normals;  // normals of the first half of a hexahedron's dual faces
    unrolled<n>([&](auto k) {
      constexpr LocalFace face = Element::dual_faces[k];
      const auto &a = dual[face.nodes[0]], &b = dual[face.nodes[1]], &c = dual[face.nodes[2]];
      if constexpr (face.size == 4) {  // the base of the dual pyramid
        const auto& d = dual[face.nodes[3]];
        const auto normal = 0.5 * cross(c - a, d - b);
        result[k] = 0.25 * (a + b + c + d) + OppositeFaceNormals::scaled(sigma, normal);
      } else if constexpr (n == 8 && k >= 4) {
        // Opposite faces of the octahedron have opposite normals (thesis, proof of Lemma 3.2).
        constexpr std::size_t opposite = (k + 2) % 4;
        result[k] = (1.0 / 3.0) * (a + b + c) - normals[opposite];
      } else {
        const auto base =
            n == 4 || n == 8 ? (1.0 / 3.0) * (a + b + c) : (1.0 - tau) * a + (0.5 * tau) * (b + c);
        const auto normal = OppositeFaceNormals::scaled(sigma, cross(b - a, c - a));
        result[k] = base + normal;
        if constexpr (n == 8) normals[k] = normal;
      }
    });
  }

 private:
  /// Returns the position of triangles' base points (Eq. 3.8). They lie on the line from the first
  /// node of the dual face to the middle of the other two. The position is chosen so that regular
  /// elements stay regular.
  template <std::size_t n, class Real>
  static inline Real base_position(Real sigma) {
    if constexpr (n == 5) return 0.5 + sigma;
    if constexpr (n == 6) {
      const double factor = std::numbers::sqrt2 / std::sqrt(std::sqrt(39.0));
      return 0.8 * (1.0 - factor * sigma);
    }
    return sigma;  // not used
  }
};

}  // namespace smoothfem
