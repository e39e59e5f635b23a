// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "fem/tests/unit_mesh.h"
#include "smoothing/mesh/volume_elements.h"

namespace smoothfem {

/// Returns a mesh with midside nodes. map: of the linear mesh's points to those of the result. A
/// midside node is the image of the mean of its corners. complete: with nodes in faces and cells
/// (TRI7, QUAD9, HEX27, ...), not only on edges (TRI6, QUAD8, HEX20, ...). Keeps the labels.
template <int dim, class Map>
Mesh<dim> second_order(const Mesh<dim>& linear, bool complete, const Map& map) {
  auto points = linear.copied_coordinates();
  std::map<std::vector<NodeIndex>, NodeIndex> nodes;
  MeshLabels labels = linear.topology().labels();
  auto midside = std::make_shared<MidsideNodes>();
  for (CellIndex c = 0; c < linear.n_cells(); ++c) {
    const auto corners = linear.topology().cell_nodes(c);
    std::vector<NodeIndex> row;
    const auto add = [&](std::vector<NodeIndex> place) {
      std::sort(place.begin(), place.end());
      const auto [node, is_new] = nodes.emplace(place, static_cast<NodeIndex>(points.size()));
      row.push_back(node->second);
      if (!is_new) return;
      Point<dim> mean = Point<dim>::Zero();
      for (const NodeIndex corner : place) mean += points[corner];
      points.push_back(mean / static_cast<double>(place.size()));
    };
    for_each_edge(dim, corners.size(), [&](std::size_t a, std::size_t b) {
      add({corners[a], corners[b]});
    });
    if (complete && dim == 3)
      for_each_quadrilateral_face(corners.size(), [&](const LocalFace& face) {
        std::vector<NodeIndex> place;
        for (const auto k : face.indices()) place.push_back(corners[k]);
        add(std::move(place));
      });
    if (complete && (dim == 2 || corners.size() == 8)) add({corners.begin(), corners.end()});
    midside->of_cells.append(row);
  }
  labels.midside = std::move(midside);
  for (auto& p : points) p = map(p);
  const std::size_t n_nodes = points.size();
  return {std::make_shared<const Topology>(dim, n_nodes, linear.topology().cells(), std::nullopt,
                                           std::move(labels)),
          std::move(points)};
}

/// Returns the mesh of second order whose midside nodes are exactly in the middle.
template <int dim>
Mesh<dim> second_order(const Mesh<dim>& linear, bool complete) {
  return second_order(linear, complete, [](const Point<dim>& p) { return p; });
}

/// Returns the mesh of a square that disc_of_square maps to the unit disc: n x n squares in the
/// middle, n rings around them. split: each cell is two triangles.
inline PlanarMesh ringed_square(std::size_t n, bool split) {
  constexpr double inner = 0.5;
  std::vector<Point<2>> points;
  std::map<std::pair<long, long>, NodeIndex> numbers;
  const auto node = [&](const Point<2>& p) {
    const auto key = std::make_pair(std::lround(1e6 * p.x()), std::lround(1e6 * p.y()));
    const auto [found, is_new] = numbers.emplace(key, static_cast<NodeIndex>(points.size()));
    if (is_new) points.push_back(p);
    return found->second;
  };
  CompressedRows<NodeIndex> cells;
  const auto step = 1.0 / static_cast<double>(n);
  // at(i, j): a corner of a block of n x n cells.
  const auto add_block = [&](const auto& at) {
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) {
        const auto corner = [&](std::size_t a, std::size_t b) {
          return node(at(step * static_cast<double>(a), step * static_cast<double>(b)));
        };
        const NodeIndex a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1),
                        d = corner(i, j + 1);
        if (!split) {
          cells.append(std::vector{a, b, c, d});
          continue;
        }
        cells.append(std::vector{a, b, c});
        cells.append(std::vector{a, c, d});
      }
  };
  add_block([&](double s, double t) -> Point<2> {
    return {inner * (2.0 * s - 1.0), inner * (2.0 * t - 1.0)};
  });
  for (int quarter = 0; quarter < 4; ++quarter)
    add_block([&](double s, double t) -> Point<2> {
      const double radius = inner + (1.0 - inner) * s;
      Point<2> p(radius, radius * (2.0 * t - 1.0));
      for (int k = 0; k < quarter; ++k) p = Point<2>(-p.y(), p.x());
      return p;
    });
  const std::size_t n_nodes = points.size();
  return {std::make_shared<Topology>(2, n_nodes, std::move(cells)), std::move(points)};
}

inline Point<2> disc_of_square(const Point<2>& p) {
  constexpr double inner = 0.5;
  const bool flat = std::abs(p.x()) >= std::abs(p.y());
  const double major = flat ? p.x() : p.y(), minor = flat ? p.y() : p.x();
  const double radius = std::abs(major);
  if (radius <= inner + 1e-12) return p;
  const double t = (radius - inner) / (1.0 - inner), ratio = minor / major,
               angle = std::numbers::pi / 4.0 * ratio, sign = major > 0.0 ? 1.0 : -1.0;
  const double a = sign * ((1.0 - t) * inner + t * std::cos(angle)),
               b = sign * ((1.0 - t) * inner * ratio + t * std::sin(angle));
  return flat ? Point<2>(a, b) : Point<2>(b, a);
}

/// Returns n layers of hexahedra on the quadrilaterals of a mesh, or of tetrahedra on its
/// triangles, between z = 0 and 1.
inline VolumeMesh extruded(const PlanarMesh& base, std::size_t n) {
  std::vector<Point<3>> points;
  for (std::size_t layer = 0; layer <= n; ++layer)
    for (const auto& p : base.coordinates())
      points.emplace_back(p.x(), p.y(), static_cast<double>(layer) / static_cast<double>(n));
  CompressedRows<NodeIndex> cells;
  const auto n_base = static_cast<NodeIndex>(base.n_nodes());
  for (NodeIndex low = 0; low < n * n_base; low += n_base)
    for (CellIndex c = 0; c < base.n_cells(); ++c) {
      const auto nodes = base.topology().cell_nodes(c);
      std::vector<NodeIndex> cell(nodes.begin(), nodes.end());
      if (cell.size() == 3) std::sort(cell.begin(), cell.end());  // so that diagonals agree
      cell.resize(2 * nodes.size());
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        cell[k] += low;
        cell[nodes.size() + k] = cell[k] + n_base;
      }
      if (nodes.size() == 4) {
        cells.append(cell);
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) {  // cell[0..k], and k..2 of the layer above
        std::array<NodeIndex, 4> tetrahedron;
        for (std::size_t i = 0; i < 4; ++i) tetrahedron[i] = cell[i <= k ? i : i + 2];
        const Point<3> a = points[tetrahedron[1]] - points[tetrahedron[0]],
                       b = points[tetrahedron[2]] - points[tetrahedron[0]],
                       d = points[tetrahedron[3]] - points[tetrahedron[0]];
        if (a.cross(b).dot(d) < 0.0) std::swap(tetrahedron[2], tetrahedron[3]);
        cells.append(std::vector<NodeIndex>(tetrahedron.begin(), tetrahedron.end()));
      }
    }
  const std::size_t n_nodes = points.size();
  return {std::make_shared<Topology>(3, n_nodes, std::move(cells)), std::move(points)};
}

/// Maps the unit square or cube to a part of a ring or spherical shell with the radii 1 and 2.
template <int dim>
Point<dim> shell_of_unit(const Point<dim>& p) {
  Point<dim> direction = Point<dim>::Ones();
  for (int d = 1; d < dim; ++d)
    direction[d] = std::tan(std::numbers::pi / 4.0 * (2.0 * p[d] - 1.0));
  return (1.0 + p[0]) * direction.normalized();
}

}  // namespace smoothfem
