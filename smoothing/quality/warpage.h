// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "smoothing/mesh/mesh.h"
#include "smoothing/mesh/volume_elements.h"
#include "smoothing/simd/vectors.h"

namespace smoothfem {

/// Cosine of the angle between two vectors, in [-1, 1]; 0 if one of them has length zero.
template <class Real>
inline Real cosine_between(Vector3<Real> a, Vector3<Real> b) {
  const Real one = Real{} + 1.0, lengths = length(a) * length(b);
  const Real cosine = lengths > 0.0 ? dot(a, b) / lengths : Real{};
  return cosine > 1.0 ? one : cosine < -1.0 ? -one : cosine;
}

/// Warpage of the quadrilateral face with nodes p_0 .. p_3 (thesis, Section 4.7; Lo et al.,
/// Generation of hexahedral meshes): w = 1 - min((n_0 . n_2)^3, (n_1 . n_3)^3). n_k is the unit
/// normal of corner k, along (p_k - p_{k+3}) x (p_{k+1} - p_k). In [0, 2]: 0 for flat convex faces,
/// 1 or more if opposite normals make at least a right angle. 1 also if a normal has length zero.
/// Independent of the first node and, up to rounding, of the direction.
template <class Real>
inline Real face_warpage(std::span<const Vector3<Real>, 4> p) {
  std::array<Vector3<Real>, 4> normals;
  for (std::size_t k = 0; k < 4; ++k)
    normals[k] = cross(p[k] - p[(k + 3) % 4], p[(k + 1) % 4] - p[k]);
  const Real a = cosine_between(normals[0], normals[2]);
  const Real b = cosine_between(normals[1], normals[3]);
  const Real least = a < b ? a : b;  // the cube keeps the order
  return 1.0 - least * least * least;
}

/// Warpage of a volume cell with n = 4, 5, 6 or 8 nodes: the largest of its quadrilateral faces, 0
/// for a tetrahedron.
template <class Real, std::size_t n>
inline Real element_warpage(std::span<const Vector3<Real>, n> nodes) {
  Real largest{};
  for (const LocalFace& face : VolumeElement<n>::faces) {
    if (face.size != 4) continue;
    const std::array<Vector3<Real>, 4> corners{nodes[face.nodes[0]], nodes[face.nodes[1]],
                                               nodes[face.nodes[2]], nodes[face.nodes[3]]};
    const Real warpage = face_warpage(std::span<const Vector3<Real>, 4>(corners));
    largest = warpage > largest ? warpage : largest;
  }
  return largest;
}

/// Warpage of the quadrilateral faces of a mesh, each counted once. All 0 if there are no such
/// faces.
struct MeshWarpage {
  double max = 0.0, mean = 0.0;
  std::size_t n_faces = 0;
};
MeshWarpage mesh_warpage(const VolumeMesh& mesh);

}  // namespace smoothfem
