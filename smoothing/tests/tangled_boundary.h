// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <numbers>

#include "smoothing/geometry/cell_size.h"
#include "smoothing/surface/sliding_boundary.h"
#include "smoothing/tests/volume_meshes.h"

/// Meshes whose inverted cells have nodes of the boundary only. Tools that make hexahedral meshes
/// produce them in thin walls and at curved boundaries.

namespace smoothfem::test {

/// A quarter of a tube with a single layer of cells in its wall.
inline VolumeMesh shell(BoxCells kind) {
  constexpr std::uint32_t n = 12;
  VolumeMesh mesh = box_mesh(2 * n, 1, n, kind);
  for (auto& p : mesh.coordinates()) {
    const double angle = 0.5 * std::numbers::pi * (1.0 - p.x() / (2 * n));
    const double radius = 1.5 + p.y() / n;
    p = {radius * std::cos(angle), radius * std::sin(angle), p.z() / n};
  }
  return mesh;
}

/// Moves nodes of the boundary's smooth parts along it at random. No facet turns by more than about
/// 14 degrees, so that its sides do not become features. Cells still turn over.
inline VolumeMesh tangled_along_boundary(VolumeMesh mesh, int n_passes = 3) {
  constexpr double largest = 0.06, min_cosine = 0.97;
  const VolumeMesh sliding = with_sliding_boundary(mesh);
  const NodeConstraints<3>& constraints = *sliding.constraints();
  const auto& facets = mesh.topology().boundary_facets();
  const auto facets_of_node = rows_by_entry(facets, mesh.n_nodes());
  Random random(3);
  for (int pass = 0; pass < n_passes; ++pass)
    for (const NodeIndex i : sliding.topology().free_nodes()) {
      if (constraints.classifications()[i].kind != GeometricClassification::patch) continue;
      const Point<3> old = mesh.coordinates()[i];
      const double a = random(), b = random(), c = random();
      mesh.coordinates()[i] =
          constraints.project(i, old, Point<3>(old + largest * Point<3>(a, b, c)));
      for (const std::uint32_t f : facets_of_node[i]) {
        const Point<3> normal = facet_normal(facets[f], mesh.coordinates());
        if (!(normal.dot(constraints.facet_normals()[f]) > min_cosine)) mesh.coordinates()[i] = old;
      }
    }
  return mesh;
}

/// A strip of one layer of cells around a quarter of a circle, with its outer side turned by up to
/// `turn`. Turned by more than about 18 degrees, the inner corners of its cells are inverted, while
/// no side of the strip is folded.
inline PlanarMesh strip(bool triangles, double turn) {
  constexpr std::uint32_t n = 40;
  std::vector<Point<2>> points;
  for (const double radius : {1.0, 1.05})
    for (std::uint32_t i = 0; i <= n; ++i) {
      const double share = static_cast<double>(i) / n;
      const double angle = 0.5 * std::numbers::pi * share +
                           (radius > 1.0 ? turn * std::sin(std::numbers::pi * share) : 0.0);
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
  std::vector<std::vector<NodeIndex>> cells;
  for (std::uint32_t i = 0; i < n; ++i) {
    const NodeIndex a = i, b = i + 1, c = n + 2 + i, d = n + 1 + i;  // b, a, d, c counterclockwise
    if (triangles) {
      cells.push_back({b, a, d});
      cells.push_back({b, d, c});
    } else {
      cells.push_back({b, a, d, c});
    }
  }
  return make_mesh(points, cells);
}

}  // namespace smoothfem::test
