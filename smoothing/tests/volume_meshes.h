// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ostream>

#include "smoothing/tests/planar_meshes.h"

namespace smoothfem::test {

inline VolumeMesh make_volume_mesh(const std::vector<Point<3>>& coordinates,
                                   const CompressedRows<NodeIndex>& cells,
                                   std::optional<std::vector<bool>> fixed = std::nullopt) {
  return {std::make_shared<const Topology>(3, coordinates.size(), cells, std::move(fixed)),
          coordinates};
}

enum class BoxCells { tetrahedra, pyramids, prisms, hexahedra, mixed };

inline const char* name_of(BoxCells kind) {
  constexpr const char* names[] = {"tetrahedra", "pyramids", "prisms", "hexahedra", "mixed"};
  return names[static_cast<int>(kind)];
}
inline void PrintTo(BoxCells kind, std::ostream* out) {
  *out << name_of(kind);
}

/// Makes nx x ny x nz unit cubes. They are hexahedra, or each is cut into six tetrahedra along a
/// diagonal, six pyramids over its middle, or two prisms. All diagonals run in the same direction,
/// so that the tetrahedra fit. mixed: prisms in the lower layers, hexahedra above them, then a
/// layer of pyramids, and tetrahedra on top. The top faces of the pyramids' cubes are cut so that
/// the tetrahedra fit.
inline VolumeMesh box_mesh(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, BoxCells kind) {
  std::vector<Point<3>> x;
  for (std::uint32_t k = 0; k <= nz; ++k)
    for (std::uint32_t j = 0; j <= ny; ++j)
      for (std::uint32_t i = 0; i <= nx; ++i) x.emplace_back(i, j, k);
  CompressedRows<NodeIndex> cells;
  using Row = std::vector<NodeIndex>;
  for (std::uint32_t k = 0; k < nz; ++k)
    for (std::uint32_t j = 0; j < ny; ++j)
      for (std::uint32_t i = 0; i < nx; ++i) {
        const NodeIndex a = (k * (ny + 1) + j) * (nx + 1) + i, up = (nx + 1) * (ny + 1);
        const NodeIndex b = a + 1, c = a + nx + 2, d = a + nx + 1;
        const std::array<NodeIndex, 8> h{a, b, c, d, a + up, b + up, c + up, d + up};
        BoxCells here = kind;
        if (kind == BoxCells::mixed)
          here = 4 * k < nz       ? BoxCells::prisms
                 : 2 * k < nz     ? BoxCells::hexahedra
                 : 2 * k < nz + 2 ? BoxCells::pyramids
                                  : BoxCells::tetrahedra;
        if (here == BoxCells::hexahedra) {
          cells.append(h);
        } else if (here == BoxCells::prisms) {
          // Turned, so that their quadrilaterals meet the hexahedra above.
          if (kind == BoxCells::mixed) {
            cells.append(Row{h[0], h[5], h[1], h[3], h[6], h[2]});
            cells.append(Row{h[0], h[4], h[5], h[3], h[7], h[6]});
          } else {
            cells.append(Row{h[0], h[1], h[2], h[4], h[5], h[6]});
            cells.append(Row{h[0], h[2], h[3], h[4], h[6], h[7]});
          }
        } else if (here == BoxCells::pyramids) {
          const auto middle = static_cast<NodeIndex>(x.size());
          x.emplace_back(i + 0.5, j + 0.5, k + 0.5);
          const bool tetrahedra_above = kind == BoxCells::mixed && k + 1 < nz;
          const auto& faces = VolumeElement<8>::faces;
          for (std::size_t f = 0; f < faces.size(); ++f) {
            const auto& n = faces[f].nodes;  // outwards; seen from the middle in reverse order
            if (tetrahedra_above && f + 1 == faces.size()) {
              cells.append(Row{h[4], h[6], h[5], middle});
              cells.append(Row{h[4], h[7], h[6], middle});
            } else {
              cells.append(Row{h[n[3]], h[n[2]], h[n[1]], h[n[0]], middle});
            }
          }
        } else {
          for (const auto& [p, q] : {std::pair{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}})
            cells.append(Row{h[0], h[p], h[q], h[6]});
        }
      }
  return make_volume_mesh(x, cells);
}

/// Makes n x n rhombs of two equilateral triangles each, in n_layers layers of regular prisms.
inline VolumeMesh equilateral_prisms(std::uint32_t n, std::uint32_t n_layers) {
  VolumeMesh mesh = box_mesh(n, n, n_layers, BoxCells::prisms);
  // The diagonal that cuts a square becomes an edge of length one.
  for (auto& p : mesh.coordinates())
    p = Point<3>(p.x() - 0.5 * p.y(), 0.5 * std::numbers::sqrt3 * p.y(), p.z());
  return mesh;
}

/// Moves each free node by up to `radius` in each direction, if its cells stay valid.
inline void distort(VolumeMesh& mesh, double radius, std::uint64_t seed) {
  Random random(seed);
  for (const NodeIndex i : mesh.topology().free_nodes()) {
    auto& here = mesh.coordinates()[i];
    const Point<3> old = here;
    const double dx = radius * random(), dy = radius * random(), dz = radius * random();
    here += Point<3>(dx, dy, dz);
    for (const CellIndex c : mesh.topology().node_cells(i))
      if (!(cell_mean_ratio(mesh, c) > 0.0)) here = old;
  }
}

template <int dim>
using NamedMeshes = std::vector<std::pair<std::string, Mesh<dim>>>;

/// Grids and boxes of unit cells, of each type of cells and of several types.
template <int dim>
NamedMeshes<dim> regular_topologies() {
  if constexpr (dim == 2)
    return {{"triangles", grid_mesh(7, GridCells::triangles)},
            {"quadrilaterals", grid_mesh(7, GridCells::quadrilaterals)},
            {"mixed", grid_mesh(7, GridCells::mixed)},
            {"pentagons", pentagon_mesh()},
            {"hexagons", honeycomb_mesh()}};
  else
    return {{"tetrahedra", box_mesh(4, 4, 4, BoxCells::tetrahedra)},
            {"pyramids", box_mesh(4, 3, 3, BoxCells::pyramids)},
            {"prisms", box_mesh(4, 4, 4, BoxCells::prisms)},
            {"hexahedra", box_mesh(4, 4, 4, BoxCells::hexahedra)},
            {"mixed", box_mesh(3, 4, 6, BoxCells::mixed)}};
}

/// The same meshes, with each free node moved by up to a quarter of a cell.
template <int dim>
NamedMeshes<dim> distorted_meshes() {
  auto all = regular_topologies<dim>();
  for (auto& [name, mesh] : all) distort(mesh, 0.25, 7);
  return all;
}

}  // namespace smoothfem::test
