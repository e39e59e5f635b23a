// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <numbers>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/embedding.h"
#include "meshes/tools/quadrilateral_region.h"
#include "meshes/tools/sweep.h"

namespace smoothfem {
namespace {

// These lengths and the layers determine the numbers of hexahedra and pyramids. Layers are thinner
// than the edges are long, which gives the thesis' mean quality without distortion.
constexpr double plate_length = 14.2, plate_width = 8.4, plate_height = 3.2;
constexpr std::size_t n_layers = 13;
constexpr double edge_length = 0.58;
struct Hole {
  Point<2> centre;
  double radius;
  int n_edges;  ///< the smaller hole has shorter edges
};
const std::array<Hole, 2> holes{{{{4.2, 4.25}, 1.4, 12}, {{10.6, 4.25}, 0.7, 10}}};

constexpr std::array<std::size_t, 3> cuboid_cells{18, 12, 10};
constexpr double cuboid_edge = 1.0;
constexpr double pyramid_height = 0.45;
/// Leaves tetrahedra of a quality as low as the worst of the thesis.
constexpr double optimization_threshold = 0.08;

std::vector<Point<2>> rectangle() {
  const std::array<Point<2>, 4> corners{Point<2>(0, 0), Point<2>(plate_length, 0),
                                        Point<2>(plate_length, plate_width),
                                        Point<2>(0, plate_width)};
  std::vector<Point<2>> polygon;
  for (std::size_t k = 0; k < 4; ++k) {
    const Point<2> side = corners[(k + 1) % 4] - corners[k];
    const int n = 2 * static_cast<int>(std::lround(0.5 * side.norm() / edge_length));
    for (int i = 0; i < n; ++i) polygon.push_back(corners[k] + side * i / n);
  }
  return polygon;
}

/// Makes quadrilaterals of the plate's outline; nodes of the holes lie on their circles.
PlanarCells footprint() {
  Polygons polygons{rectangle()};
  for (const Hole& hole : holes) {
    polygons.emplace_back();
    for (int i = 0; i < hole.n_edges; ++i)
      polygons.back().push_back(
          on_circle(hole.centre, hole.radius, 2.0 * std::numbers::pi * i / hole.n_edges));
  }
  return mesh_quadrilaterals(polygons, edge_length);
}

/// Adds the sides of the cuboid around the plate, as triangles.
CompressedRows<NodeIndex> append_cuboid(VolumeCells& mesh) {
  std::array<double, 3> corner{};
  const std::array<double, 3> plate{plate_length, plate_width, plate_height};
  for (std::size_t d = 0; d < 3; ++d)
    corner[d] = 0.5 * (plate[d] - cuboid_edge * static_cast<double>(cuboid_cells[d]));
  const auto [nx, ny, nz] = cuboid_cells;
  std::vector<NodeIndex> number((nx + 1) * (ny + 1) * (nz + 1), static_cast<NodeIndex>(-1));
  const auto node = [&, nx = nx, ny = ny](std::array<std::size_t, 3> at) {
    NodeIndex& known = number[at[0] + (nx + 1) * (at[1] + (ny + 1) * at[2])];
    if (known == static_cast<NodeIndex>(-1)) {
      known = static_cast<NodeIndex>(mesh.coordinates.size());
      Point<3> p;
      for (std::size_t d = 0; d < 3; ++d)
        p[static_cast<int>(d)] = corner[d] + cuboid_edge * static_cast<double>(at[d]);
      mesh.coordinates.push_back(p);
    }
    return known;
  };
  CompressedRows<NodeIndex> triangles;
  for (std::size_t d = 0; d < 3; ++d) {
    const std::size_t u = (d + 1) % 3, v = (d + 2) % 3;
    for (const std::size_t level : {std::size_t{0}, cuboid_cells[d]})
      for (std::size_t i = 0; i < cuboid_cells[u]; ++i)
        for (std::size_t j = 0; j < cuboid_cells[v]; ++j) {
          const auto at = [&](std::size_t di, std::size_t dj) {
            std::array<std::size_t, 3> position{};
            position[d] = level;
            position[u] = i + di;
            position[v] = j + dj;
            return node(position);
          };
          const bool even = (i + j) % 2 == 0;  // alternating diagonals
          triangles.append(
              std::array<NodeIndex, 3>{at(0, 0), at(1, 0), even ? at(1, 1) : at(0, 1)});
          triangles.append(
              std::array<NodeIndex, 3>{even ? at(0, 0) : at(1, 0), at(1, 1), at(0, 1)});
        }
  }
  return triangles;
}

/// A plate with two holes, of hexahedra, in a cuboid of tetrahedra, with a layer of pyramids
/// between both. It has within 3 % the 5,748 hexahedra, 2,220 pyramids and 26,082 tetrahedra of the
/// thesis (Section 5.4.1), and within .01 its lowest and mean quality of .1625 and .7302. Only the
/// nodes on the cuboid's sides are fixed. Throws InputError if the edge scale is not 1.
AnyMesh generate(const DomainParameters& p) {
  require_edge_scale("plate", p.edge_scale, 1);
  std::vector<double> heights;
  for (std::size_t k = 0; k <= n_layers; ++k)
    heights.push_back(plate_height * static_cast<double>(k) / n_layers);
  VolumeCells mesh = sweep(footprint(), heights);
  const auto sides = Topology(3, mesh.coordinates.size(), mesh.cells).boundary_facets();
  const auto wrap = append_pyramids(mesh, sides, pyramid_height);
  const auto cuboid = append_cuboid(mesh);
  append_tetrahedra(mesh, {cuboid, wrap}, 1.2 * cuboid_edge, "the space around the plate",
                    optimization_threshold);
  return mesh_of(std::move(mesh), "generated plate");
}

const RegisteredDomain registered(
    {.name = "plate",
     .description =
         "stand-in for Section 5.4.1's mesh: about its counts, a plate with two holes in a cuboid",
     .dimension = 3,
     .elements = {"mixed"},
     .make = generate});

}  // namespace
}  // namespace smoothfem
