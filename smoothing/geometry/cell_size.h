// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "smoothing/mesh/node_constraints.h"
#include "smoothing/mesh/volume_elements.h"
#include "smoothing/simd/cells.h"

namespace smoothfem {

/// Area of a polygon; negative if its corners run clockwise. Coordinates are taken relative to the
/// first corner: products of large coordinates would cancel far from the origin.
template <class Real, std::size_t extent>
inline Real signed_cell_size(std::span<const Vector2<Real>, extent> corners) {
  Real twice_area{};
  for (std::size_t k = 2; k < corners.size(); ++k)
    twice_area += cross(corners[k - 1] - corners[0], corners[k] - corners[0]);
  return 0.5 * twice_area;
}

/// Volume of a cell with bilinear quadrilateral faces; negative for inverted cells. Each such face
/// bounds the mean of the volumes of its two divisions into triangles. The volume is the sum of the
/// tetrahedra that the faces' triangles form with the first node.
template <class Real, std::size_t n>
inline Real signed_cell_size(std::span<const Vector3<Real>, n> nodes) {
  Real six_volumes{};
  unrolled<VolumeElement<n>::faces.size()>([&](auto f) {
    constexpr LocalFace face = VolumeElement<n>::faces[f];
    const auto add = [&](Real& sum, auto a, auto b, auto c) {
      constexpr LocalIndex i = face.nodes[a], j = face.nodes[b], k = face.nodes[c];
      if constexpr (i != 0 && j != 0 && k != 0)
        sum += dot(nodes[i] - nodes[0], cross(nodes[j] - nodes[0], nodes[k] - nodes[0]));
    };
    constexpr std::integral_constant<std::size_t, 0> a;
    constexpr std::integral_constant<std::size_t, 1> b;
    constexpr std::integral_constant<std::size_t, 2> c;
    if constexpr (face.size == 3) {
      add(six_volumes, a, b, c);
    } else {
      constexpr std::integral_constant<std::size_t, 3> d;
      Real both_divisions{};
      add(both_divisions, a, b, c);
      add(both_divisions, a, c, d);
      add(both_divisions, a, b, d);
      add(both_divisions, b, c, d);
      six_volumes += 0.5 * both_divisions;
    }
  });
  return six_volumes / 6.0;
}

/// Area or volume of a cell of a mesh, with the same sign.
template <int dim>
inline double signed_cell_size(const Mesh<dim>& mesh, CellIndex cell) {
  double size = 0.0;
  with_corners<dim>(mesh.topology().cell_nodes(cell), mesh.coordinates().data(),
                    [&](auto corners) { size = signed_cell_size(corners); });
  return size;
}

/// Area vector of a polygon in space: along its mean normal, twice as long as its area.
inline Point<3> area_vector(std::span<const NodeIndex> nodes,
                            std::span<const Point<3>> coordinates) {
  Point<3> sum = Point<3>::Zero();
  for (std::size_t k = 2; k < nodes.size(); ++k)
    sum += (coordinates[nodes[k - 1]] - coordinates[nodes[0]])
               .cross(coordinates[nodes[k]] - coordinates[nodes[0]]);
  return sum;
}

/// Unit vector along the mean normal of a polygon in space; zero for a polygon without area. Works
/// also where the square of its area overflows or underflows.
inline Point<3> facet_normal(std::span<const NodeIndex> nodes,
                             std::span<const Point<3>> coordinates) {
  constexpr double least = 0x1p-500, largest = 0x1p500;
  const Point<3> area = area_vector(nodes, coordinates);
  const double size = area.norm();
  return size > least && size < largest ? area.normalized() : area.stableNormalized();
}

/// Area of the cell of a surface mesh, projected along its mean normal; negative if it is turned
/// over.
inline double signed_cell_size(const SurfaceMesh& mesh, CellIndex cell) {
  const Point<3> area = area_vector(mesh.topology().cell_nodes(cell), mesh.coordinates());
  return 0.5 * std::copysign(1.0, area.dot(mesh.constraints()->facet_normals()[cell])) *
         area.stableNorm();
}

}  // namespace smoothfem
