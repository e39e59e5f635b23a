// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/gmsh_volume.h"
#include "meshes/tools/quadrilateral_region.h"
#include "meshes/tools/sweep.h"

namespace smoothfem {
namespace {

/// Completes half of a symmetric polygon, given from its lowest to its highest point on the right.
Outline mirrored(std::vector<Point<2>> right) {
  for (std::size_t i = right.size(); i-- > 0;) {
    const Point<2> p = right[i];
    right.emplace_back(-p.x(), p.y());
  }
  return closed(right);
}

constexpr double girder_length = 8.2;  // layers of hexahedra are as thick as their edges are long

/// Cross section in metres: a slab of 11 on a box of 2.4 in height; the ducts are in the webs.
std::vector<Outline> cross_section() {
  constexpr double duct_radius = 0.09;
  std::vector<Outline> outlines{mirrored({{2.25, 0.0}, {2.75, 1.9}, {5.5, 2.1}, {5.5, 2.4}}),
                                mirrored({{1.85, 0.4}, {2.25, 1.85}, {1.85, 2.05}})};
  for (const double side : {-1.0, 1.0})
    for (const double y : {0.7, 1.4})
      outlines.push_back(circle({side * (2.06 + 0.5 * y / 1.9), y}, duct_radius));
  return outlines;
}

VolumeCells hexahedra(double edge_scale) {
  // Number of boundary edges of 1,944 cells with 2,278 nodes and five holes (Euler).
  constexpr std::size_t n_cells = 1944, n_boundary_edges = 676;
  constexpr double n_layers = 134.0;
  PlanarCells base =
      mesh_with_n_quadrilaterals(cross_section(), n_cells, n_boundary_edges, edge_scale);
  smooth_quadrilaterals(base);
  return sweep(base, equal_layers(girder_length, n_layers / edge_scale));
}

VolumeCells tetrahedra(double edge_scale) {
  Polygons polygons;
  for (const Outline& outline : cross_section())
    polygons.push_back(divide({outline}, std::max<std::size_t>(8, outline.size()), 1).front());
  // On the boundary and inside: these two lengths determine the numbers of nodes and cells.
  constexpr EdgeLengths lengths{0.133, 0.0975};
  return mesh_extrusion(polygons, girder_length,
                        {edge_scale * lengths.boundary, edge_scale * lengths.inside});
}

/// A stand-in for a part of a prestressed concrete bridge (thesis, Section 5.1.3): a box girder
/// along z with four straight tendon ducts. Hexahedra: 307,530 nodes and 260,496 cells as in the
/// thesis, the cross section swept in 134 layers. Tetrahedra, by Gmsh: with octagonal ducts, about
/// 53,978 nodes and 262,201 cells (within 2 %). edge_scale (1 to 2) gives edge_scale^3 times fewer
/// cells. Throws InputError for another edge scale.
AnyMesh generate(const DomainParameters& p) {
  require_edge_scale("bridge", p.edge_scale, 2);
  return mesh_of(p.elements == "tetrahedra" ? tetrahedra(p.edge_scale) : hexahedra(p.edge_scale),
                 "generated bridge");
}

const RegisteredDomain registered(
    {.name = "bridge",
     .description =
         "stand-in for Section 5.1.3's meshes: their size, a box girder with four tendon ducts",
     .dimension = 3,
     .elements = {"tetrahedra", "hexahedra"},
     .make = generate});

}  // namespace
}  // namespace smoothfem
