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
  return {std::make_shared<const Topology>(coordinates.size(), rows_of(cells), std::move(fixed)),
          coordinates};
}

enum class GridCells { triangles, quadrilaterals, mixed };

/// n x n unit squares, seen as quadrilaterals, cut into two triangles each, or both by turns. With
/// height sqrt(3)/2 and half an edge of shift a row (equilateral = true) the triangles are regular.
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

/// Numbers in [-1, 1), the same on every machine (SplitMix64).
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

/// Moves each free node by up to `radius` in x and y where its cells stay valid.
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
