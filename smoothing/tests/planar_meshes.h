// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "smoothing/mesh/mesh.h"
#include "smoothing/quality/mean_ratio.h"

namespace smoothfem::test {

using Cells = std::vector<std::vector<NodeIndex>>;

inline CompressedRows<NodeIndex> rows_of(const Cells& cells) {
  CompressedRows<NodeIndex> rows;
  for (const auto& cell : cells) rows.append(cell);
  return rows;
}

inline PlanarMesh make_mesh(const std::vector<Point<2>>& coordinates, const Cells& cells,
                            std::optional<std::vector<bool>> fixed = std::nullopt) {
  return {std::make_shared<const Topology>(2, coordinates.size(), rows_of(cells), std::move(fixed)),
          coordinates};
}

enum class GridCells { triangles, quadrilaterals, mixed };

/// Makes n x n unit squares: quadrilaterals, cut into two triangles each, or both in turn. With
/// equilateral = true the rows have the height sqrt(3)/2 and are shifted by half an edge each, so
/// that the triangles are regular.
inline PlanarMesh grid_mesh(std::uint32_t n, GridCells kind, bool equilateral = false) {
  std::vector<Point<2>> x;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i)
      x.emplace_back(i + (equilateral ? 0.5 * j : 0.0),
                     (equilateral ? 0.5 * std::numbers::sqrt3 : 1.0) * j);
  Cells cells;
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const NodeIndex a = j * (n + 1) + i, b = a + 1, d = a + n + 1, c = d + 1;
      if (kind == GridCells::quadrilaterals || (kind == GridCells::mixed && (i + 2 * j) % 3 != 0)) {
        cells.push_back({a, b, c, d});
      } else {
        cells.push_back({a, b, d});
        cells.push_back({b, c, d});
      }
    }
  return make_mesh(x, cells);
}

/// Makes a pentagon surrounded by five others; its nodes are free.
inline PlanarMesh pentagon_mesh() {
  std::vector<Point<2>> x;
  const auto add = [&x](double radius, double turn) {
    const double angle = 2.0 * std::numbers::pi * turn;
    x.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  };
  Cells cells{{0, 1, 2, 3, 4}};
  for (int k = 0; k < 5; ++k) add(1.0, k / 5.0);
  for (int k = 0; k < 5; ++k) add(2.0, k / 5.0);
  for (int k = 0; k < 5; ++k) add(2.3, (k + 0.5) / 5.0);
  for (NodeIndex k = 0; k < 5; ++k) {
    const NodeIndex next = (k + 1) % 5;
    cells.push_back({k, 5 + k, 10 + k, 5 + next, next});
  }
  return make_mesh(x, cells);
}

/// Makes three rings of regular hexagons with edges of length one around a regular hexagon.
inline PlanarMesh honeycomb_mesh() {
  constexpr double s = 0.5 * std::numbers::sqrt3;
  std::vector<Point<2>> x;
  Cells cells;
  const auto node_at = [&x](const Point<2>& position) {
    for (NodeIndex i = 0; i < x.size(); ++i)
      if ((x[i] - position).norm() < 1e-6) return i;
    x.push_back(position);
    return static_cast<NodeIndex>(x.size() - 1);
  };
  for (int j = -3; j <= 3; ++j)
    for (int i = -3; i <= 3; ++i) {
      if (std::abs(i + j) > 3) continue;
      const Point<2> centre(2.0 * s * (i + 0.5 * j), 1.5 * j);
      cells.emplace_back();
      for (const auto& [dx, dy] :
           {std::pair{0.0, -1.0}, {s, -0.5}, {s, 0.5}, {0.0, 1.0}, {-s, 0.5}, {-s, -0.5}})
        cells.back().push_back(node_at(centre + Point<2>(dx, dy)));
    }
  return make_mesh(x, cells);
}

/// Random numbers in [-1, 1), the same on every machine (SplitMix64).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  double operator()() {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
  }

 private:
  std::uint64_t state_;
};

/// Moves each free node by up to `radius` in x and y, if its cells stay valid.
inline void distort(PlanarMesh& mesh, double radius, std::uint64_t seed) {
  Random random(seed);
  for (const NodeIndex i : mesh.topology().free_nodes()) {
    auto& here = mesh.coordinates()[i];
    const Point<2> old = here;
    const double dx = radius * random(), dy = radius * random();
    here += Point<2>(dx, dy);
    for (const CellIndex c : mesh.topology().node_cells(i))
      if (!(cell_mean_ratio(mesh, c) > 0.0)) here = old;
  }
}

}  // namespace smoothfem::test
