// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/embedding.h"
#include "meshes/tools/tensor_grid.h"

namespace smoothfem {
namespace {

// The thesis has 7,486 hexahedra and 1,618 pyramids; these radii give 7,480 and 1,624.
constexpr double ring_radius = 7.25, tube_radius = 0.8, cavity_radius = 3.8;
constexpr std::array<std::size_t, 3> n_cells{24, 25, 16};
constexpr std::size_t n_along = 201, n_around = 13;  // a torus of 2 * 201 * 13 triangles
// Each section is turned by about half a node, so that triangles get equal sides. The whole way
// around adds up to this number of nodes.
constexpr std::size_t n_turned = 100;
constexpr double pyramid_height = 0.4;  // below 0.5, where pyramids in one cell's room would meet
constexpr double edge_length = 0.467;   // gives about 74,000 tetrahedra

Point<3> centre() {
  return {0.5 * n_cells[0], 0.5 * n_cells[1], 0.5 * n_cells[2]};
}

bool in_cavity(const Point<3>& p) {
  const Point<3> d = p - centre();
  return std::hypot(std::hypot(d.x(), d.y()) - ring_radius, d.z()) < cavity_radius;
}

/// The grid's hexahedra outside the cavity.
VolumeCells outer_grid() {
  std::array<std::vector<double>, 3> planes;
  for (std::size_t d = 0; d < 3; ++d)
    for (std::size_t i = 0; i <= n_cells[d]; ++i) planes[d].push_back(static_cast<double>(i));
  return tensor_grid(planes, [&](std::size_t i, std::size_t j, std::size_t k) {
    const Point<3> corner(planes[0][i], planes[1][j], planes[2][k]);
    return !in_cavity(corner + Point<3>::Constant(0.5));
  });
}

/// Faces between the hexahedra and the cavity.
CompressedRows<NodeIndex> cavity_faces(const VolumeCells& grid) {
  const auto faces = Topology(3, grid.coordinates.size(), grid.cells).boundary_facets();
  CompressedRows<NodeIndex> inner;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    Point<3> middle = Point<3>::Zero();
    for (const NodeIndex node : faces[f]) middle += 0.25 * grid.coordinates[node];
    bool outer = false;
    for (int d = 0; d < 3; ++d)
      outer = outer || middle[d] == 0.0 || middle[d] == static_cast<double>(n_cells[d]);
    if (!outer) inner.append(faces[f]);
  }
  return inner;
}

CompressedRows<NodeIndex> append_torus(VolumeCells& mesh) {
  const auto first = static_cast<NodeIndex>(mesh.coordinates.size());
  constexpr double turn = 2.0 * std::numbers::pi;
  for (std::size_t i = 0; i < n_along; ++i)
    for (std::size_t j = 0; j < n_around; ++j) {
      const double along = turn * static_cast<double>(i) / n_along;
      const double around =
          turn * (static_cast<double>(j) + n_turned * static_cast<double>(i) / n_along) / n_around;
      const double distance = ring_radius + tube_radius * std::cos(around);
      mesh.coordinates.push_back(centre() + Point<3>(distance * std::cos(along),
                                                     distance * std::sin(along),
                                                     tube_radius * std::sin(around)));
    }
  const auto node = [&](std::size_t i, std::size_t j) {
    const std::size_t turned = i < n_along ? j : j + n_turned;
    return static_cast<NodeIndex>(first + (i % n_along) * n_around + turned % n_around);
  };
  CompressedRows<NodeIndex> triangles;
  for (std::size_t i = 0; i < n_along; ++i)
    for (std::size_t j = 0; j < n_around; ++j) {
      triangles.append(std::array<NodeIndex, 3>{node(i, j), node(i + 1, j), node(i, j + 1)});
      triangles.append(
          std::array<NodeIndex, 3>{node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
    }
  return triangles;
}

/// A ring-shaped hole in a cuboid of 24 x 25 x 16 unit hexahedra (thesis, Section 5.4.2). The
/// hexahedra within three layers around the ring are replaced by tetrahedra, with one layer of
/// pyramids between both. The ring is a torus of 5,226 triangles. Boundary nodes, also those of the
/// ring, are fixed. Throws InputError if the edge scale is not 1.
AnyMesh generate(const DomainParameters& p) {
  require_edge_scale("ring", p.edge_scale, 1);
  VolumeCells mesh = outer_grid();
  const auto cavity = append_pyramids(mesh, cavity_faces(mesh), pyramid_height);
  const auto torus = append_torus(mesh);
  append_tetrahedra(mesh, {cavity, torus}, edge_length, "the space around the ring");
  return mesh_of(std::move(mesh), "generated ring");
}

const RegisteredDomain registered(
    {.name = "ring",
     .description = "stand-in for Section 5.4.2's mesh: its grid and counts, around a torus",
     .dimension = 3,
     .elements = {"mixed"},
     .make = generate});

}  // namespace
}  // namespace smoothfem
