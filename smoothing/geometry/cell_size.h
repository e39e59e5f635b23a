// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "smoothing/mesh/node_constraints.h"
#include "smoothing/mesh/volume_elements.h"
#include "smoothing/simd/vectors.h"

namespace smoothfem {

/// Area of a planar cell; negative if its nodes run clockwise. From the first node, as products of
/// the coordinates themselves would cancel far from the origin.
inline double signed_cell_size(const PlanarMesh& mesh, CellIndex cell) {
  const auto nodes = mesh.topology().cell_nodes(cell);
  const auto x = mesh.coordinates();
  const Point<2>& origin = x[nodes[0]];
  double twice_area = 0.0;
  for (std::size_t k = 2; k < nodes.size(); ++k)
    twice_area += cross(Point<2>(x[nodes[k - 1]] - origin), Point<2>(x[nodes[k]] - origin));
  return 0.5 * twice_area;
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

/// Unit vector along the mean normal of a polygon in space, also where the squares of its area
/// leave the range of numbers. Zero for a polygon without area.
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

/// Volume of a volume cell whose quadrilateral faces are bilinear (each holds as much as the mean
/// of its two divisions into triangles); negative for cells turned inside out.
inline double signed_cell_size(const VolumeMesh& mesh, CellIndex cell) {
  const auto nodes = mesh.topology().cell_nodes(cell);
  const auto x = mesh.coordinates();
  const Point<3>& origin = x[nodes[0]];
  double six_volumes = 0.0;
  for (const LocalFace& face : volume_element(nodes.size()).faces) {
    std::array<Point<3>, 4> p;
    for (std::size_t k = 0; k < face.size; ++k) p[k] = x[nodes[face.nodes[k]]] - origin;
    const auto triangle = [&](int a, int b, int c) { return dot<3>(p[a], p[b].cross(p[c])); };
    six_volumes +=
        face.size == 3
            ? triangle(0, 1, 2)
            : 0.5 * (triangle(0, 1, 2) + triangle(0, 2, 3) + triangle(0, 1, 3) + triangle(1, 2, 3));
  }
  return six_volumes / 6.0;
}

}  // namespace smoothfem
