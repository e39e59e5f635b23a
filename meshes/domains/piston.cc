// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmsh.h>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/gmsh_tetrahedra.h"

namespace smoothfem {
namespace {

constexpr double radius = 4.0, height = 7.0;
constexpr double wall = 0.6, crown = 1.4;  // around and above the hollow
constexpr double bowl_radius = 2.2, bowl_depth = 0.5;
constexpr double pin_radius = 0.9, pin_height = 2.8;
constexpr double groove_depth = 0.3, groove_height = 0.25, groove_distance = 0.55;
constexpr int n_grooves = 3;
constexpr double edge_length = 0.0527;  // of the mesh with 4.1 million tetrahedra

void build_geometry() {
  namespace occ = gmsh::model::occ;
  const int body = occ::addCylinder(0, 0, 0, 0, 0, height, radius);
  gmsh::vectorpair removed;
  removed.emplace_back(3, occ::addCylinder(0, 0, -1, 0, 0, height - crown + 1, radius - wall));
  removed.emplace_back(3, occ::addCylinder(0, 0, height - bowl_depth, 0, 0, 1, bowl_radius));
  removed.emplace_back(3,
                       occ::addCylinder(-2 * radius, 0, pin_height, 4 * radius, 0, 0, pin_radius));
  gmsh::vectorpair rest;
  std::vector<gmsh::vectorpair> origin;
  for (int i = 0; i < n_grooves; ++i) {
    const double z = height - 0.5 - i * groove_distance - groove_height;
    gmsh::vectorpair ring;
    occ::cut({{3, occ::addCylinder(0, 0, z, 0, 0, groove_height, 2 * radius)}},
             {{3, occ::addCylinder(0, 0, z, 0, 0, groove_height, radius - groove_depth)}}, ring,
             origin);
    removed.insert(removed.end(), ring.begin(), ring.end());
  }
  occ::cut({{3, body}}, removed, rest, origin);
  occ::synchronize();
}

/// A piston: a cylinder with grooves, a bowl, a hollow below and a hole for the pin, meshed with
/// tetrahedra of equal size (thesis, Section 5.5.2). Edge scale 1: about 4,129,608 tetrahedra; up
/// to 12. Boundary nodes are fixed. Throws InputError for an edge scale out of range.
AnyMesh generate(const DomainParameters& p) {
  require_edge_scale("piston", p.edge_scale, 12);
  return mesh_of(mesh_with_tetrahedra("the piston",
                                      [&](GmshSession& session) {
                                        build_geometry();
                                        set_edge_length(session, p.edge_scale * edge_length);
                                      }),
                 "generated piston");
}

const RegisteredDomain registered(
    {.name = "piston",
     .description =
         "stand-in for Section 5.5.2's mesh: its size, a piston with bowl, grooves and pin hole",
     .dimension = 3,
     .elements = {"tetrahedra"},
     .make = generate});

}  // namespace
}  // namespace smoothfem
