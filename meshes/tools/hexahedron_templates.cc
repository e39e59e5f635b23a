// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/hexahedron_templates.h"

#include <cstddef>

namespace smoothfem {

namespace {

/// The digits of each number are a point's x, y and z.
using Row = std::array<int, 8>;

/// For the edge from 0 to 300: cells around its middle third, at its ends, and behind in y and in
/// z.
constexpr std::array<Row, 5> edge_rows{{{100, 200, 220, 120, 102, 202, 222, 122},
                                        {0, 100, 120, 30, 3, 102, 122, 33},
                                        {200, 300, 330, 220, 202, 303, 333, 222},
                                        {120, 220, 330, 30, 122, 222, 333, 33},
                                        {102, 202, 222, 122, 3, 303, 333, 33}}};

/// For the face z = 0: divided along x like an edge; each of the three cells at the face is then
/// divided along y. The result is a layer of nine, three behind it, and one at the opposite face.
constexpr std::array<Row, 13> face_rows{{{0, 100, 110, 10, 3, 102, 111, 12},
                                         {100, 200, 210, 110, 102, 202, 211, 111},
                                         {200, 300, 310, 210, 202, 303, 312, 211},
                                         {10, 110, 120, 20, 12, 111, 121, 22},
                                         {110, 210, 220, 120, 111, 211, 221, 121},
                                         {210, 310, 320, 220, 211, 312, 322, 221},
                                         {20, 120, 130, 30, 22, 121, 132, 33},
                                         {120, 220, 230, 130, 121, 221, 232, 132},
                                         {220, 320, 330, 230, 221, 322, 333, 232},
                                         {12, 111, 121, 22, 3, 102, 132, 33},
                                         {111, 211, 221, 121, 102, 202, 232, 132},
                                         {211, 312, 322, 221, 202, 303, 333, 232},
                                         {102, 202, 232, 132, 3, 303, 333, 33}}};

/// Returns the cells, turned so that x becomes the given axis.
template <std::size_t n>
std::vector<LatticeCell> turned(const std::array<Row, n>& rows, int x_becomes) {
  const auto axis = [&](int k) { return static_cast<std::size_t>((x_becomes + k) % 3); };
  std::vector<LatticeCell> cells;
  for (const Row& row : rows) {
    LatticeCell& cell = cells.emplace_back();
    for (std::size_t k = 0; k < row.size(); ++k) {
      cell[k][axis(0)] = row[k] / 100;
      cell[k][axis(1)] = row[k] / 10 % 10;
      cell[k][axis(2)] = row[k] % 10;
    }
  }
  return cells;
}

LatticeCell cube(int x, int y, int z, int edge) {
  const int u = x + edge, v = y + edge, w = z + edge;
  return {{{x, y, z}, {u, y, z}, {u, v, z}, {x, v, z}, {x, y, w}, {u, y, w}, {u, v, w}, {x, v, w}}};
}

}  // namespace

std::vector<LatticeCell> edge_template(int axis) {
  return turned(edge_rows, axis);
}

std::vector<LatticeCell> face_template(int axis) {
  return turned(face_rows, axis + 1);
}

std::vector<LatticeCell> volume_template() {
  std::vector<LatticeCell> cells;
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x) cells.push_back(cube(x, y, z, 1));
  return cells;
}

std::vector<LatticeCell> whole_template() {
  return {cube(0, 0, 0, 3)};
}

}  // namespace smoothfem
