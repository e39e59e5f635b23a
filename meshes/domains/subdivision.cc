// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <map>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/hexahedron_templates.h"
#include "meshes/tools/mesh_cells.h"

namespace smoothfem {
namespace {

constexpr int n_levels_of_thesis = 10;
constexpr double octant_edge = 1000.0;

/// True if the cell is one of the 2 x 2 x 2 thirds next to the origin.
bool is_refined_further(const LatticeCell& cell) {
  return std::all_of(cell.begin(), cell.end(), [](const LatticePoint& p) {
    return std::all_of(p.begin(), p.end(), [](int x) { return x <= 2; });
  });
}

/// Returns the cells of one of the eight cubes of an octant. `far` marks the axes along which it is
/// the outer one.
std::vector<LatticeCell> cells_of_cube(const LatticePoint& far, bool is_last_level) {
  const int n_far = far[0] + far[1] + far[2];
  if (n_far == 3) return whole_template();
  const auto axis_with = [&](int value) {
    return static_cast<int>(std::find(far.begin(), far.end(), value) - far.begin());
  };
  if (n_far == 2) return edge_template(axis_with(0));
  if (n_far == 1) return face_template(axis_with(1));
  auto cells = volume_template();
  if (!is_last_level) std::erase_if(cells, is_refined_further);
  return cells;
}

/// Returns lattice cells of the positive octant in units of the last level's thirds.
std::vector<LatticeCell> octant(int n_levels) {
  std::vector<LatticeCell> cells;
  int third = 1;  // of a cube's edge, first at the last level
  for (int level = n_levels; level > 0; --level, third *= 3)
    for (int number = 0; number < 8; ++number) {
      const LatticePoint far{number & 1, number >> 1 & 1, number >> 2};
      for (LatticeCell cell : cells_of_cube(far, level == n_levels)) {
        for (LatticePoint& point : cell)
          for (std::size_t k = 0; k < 3; ++k) point[k] = third * (3 * far[k] + point[k]);
        cells.push_back(cell);
      }
    }
  return cells;
}

/// Mirrors the octant to all octants. An odd number of mirrorings inverts cells; swapping their two
/// faces undoes that.
VolumeCells mirrored(const std::vector<LatticeCell>& cells, double unit) {
  VolumeCells cube;
  std::map<LatticePoint, NodeIndex> numbers;
  for (int number = 0; number < 8; ++number) {
    const LatticePoint sign{1 - 2 * (number & 1), 1 - 2 * (number >> 1 & 1), 1 - 2 * (number >> 2)};
    const bool inside_out = sign[0] * sign[1] * sign[2] < 0;
    for (const LatticeCell& cell : cells) {
      std::array<NodeIndex, 8> nodes{};
      for (std::size_t k = 0; k < 8; ++k) {
        const LatticePoint& p = cell[inside_out ? (k + 4) % 8 : k];
        const LatticePoint image{sign[0] * p[0], sign[1] * p[1], sign[2] * p[2]};
        const auto [entry, is_new] =
            numbers.emplace(image, static_cast<NodeIndex>(cube.coordinates.size()));
        if (is_new) cube.coordinates.push_back(unit * Point<3>(image[0], image[1], image[2]));
        nodes[k] = entry->second;
      }
      cube.cells.append(nodes);
    }
  }
  return cube;
}

/// The subdivision mesh of the thesis, Section 5.3.2, before its distortion: a cube with edges 2000
/// and its centre at the origin, refined towards the centre.
///
/// An octant is cut into eight cubes. The templates of hexahedron_templates.h refine the one at the
/// centre in all directions, and its neighbours where they touch it. The two thirds of that cube
/// next to the centre are the next level's octant. Ten levels give the 6,165 nodes and 5,984
/// hexahedra of the thesis. edge_scale (1 to 10) divides the number of levels. Throws InputError
/// for another edge scale.
AnyMesh generate(const DomainParameters& p) {
  require_edge_scale("subdivision mesh", p.edge_scale, n_levels_of_thesis);
  const int n_levels = static_cast<int>(std::lround(n_levels_of_thesis / p.edge_scale));
  const double unit = octant_edge / (2.0 * std::pow(3.0, n_levels));
  return mesh_of(mirrored(octant(n_levels), unit), "generated subdivision mesh");
}

const RegisteredDomain registered(
    {.name = "subdivision",
     .description =
         "Section 5.3.2's cube, refined ten times towards its centre: the same mesh, undistorted",
     .dimension = 3,
     .elements = {"hexahedra"},
     .make = generate});

}  // namespace
}  // namespace smoothfem
