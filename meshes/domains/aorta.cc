// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmsh.h>
#include <Eigen/Geometry>

#include <array>
#include <numbers>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/gmsh_tetrahedra.h"
#include "meshes/tools/unit_vector.h"
#include "smoothing/geometry/cell_size.h"
#include "smoothing/surface/surface_features.h"

namespace smoothfem {
namespace {

constexpr double arch_radius = 20.0, radius = 4.0, branch_radius = 2.4;
constexpr double ascending = 25.0, descending = 60.0, branch_length = 16.0;
constexpr double branch_foot = 0.8 * arch_radius;
constexpr double blend_radius = 1.5;  ///< of the fillets where branches begin
constexpr double boundary_edge = 0.854, inner_edge = 1.2;
/// Thin compared with the edges: the prisms have a mean ratio of about 0.087, as in the thesis.
constexpr double layer_height = 0.012;
constexpr int n_layers = 6;

/// Returns the curves of the model where a branch meets the arch. They lie between the vessel's
/// ends, and not in its plane of symmetry like the seams of the parts.
std::vector<int> branch_curves() {
  gmsh::vectorpair curves;
  gmsh::model::getEntities(curves, 1);
  std::vector<int> found;
  for (const auto& [dim, tag] : curves) {
    double x0 = 0, y0 = 0, z0 = 0, x1 = 0, y1 = 0, z1 = 0;
    gmsh::model::getBoundingBox(dim, tag, x0, y0, z0, x1, y1, z1);
    const bool is_at_branch = y0 > 0.5 * arch_radius && y1 < branch_foot + branch_length - radius;
    if (is_at_branch && z1 - z0 > 0.5 * branch_radius) found.push_back(tag);
  }
  return found;
}

void build_geometry() {
  namespace occ = gmsh::model::occ;
  const int arch = occ::addTorus(0, 0, 0, arch_radius, radius, -1, std::numbers::pi);
  const gmsh::vectorpair parts{
      {3, occ::addCylinder(arch_radius, 0, 0, 0, -ascending, 0, radius)},
      {3, occ::addCylinder(-arch_radius, 0, 0, 0, -descending, 0, radius)},
      {3, occ::addCylinder(-6, branch_foot, 0, -3, branch_length, 0, branch_radius)},
      {3, occ::addCylinder(6, branch_foot, 0, 3, branch_length, 0, branch_radius)}};
  gmsh::vectorpair whole;
  std::vector<gmsh::vectorpair> origin;
  occ::fuse({{3, arch}}, parts, whole, origin);
  occ::synchronize();
  gmsh::vectorpair blended;
  occ::fillet({whole.front().second}, branch_curves(), {blend_radius}, blended);
  occ::synchronize();
}

VolumeCells tetrahedra() {
  return mesh_with_tetrahedra("the vessel", [](GmshSession& session) {
    build_geometry();
    set_edge_length(session, boundary_edge);
    gmsh::model::mesh::generate(2);
    set_edge_length(session, inner_edge);
    session.set_option("Mesh.CharacteristicLengthMin", 0.0);
  });
}

/// Returns the sums of the boundary triangles' normals, with unit length.
std::vector<Point<3>> node_normals(const VolumeCells& mesh,
                                   const CompressedRows<NodeIndex>& triangles) {
  std::vector<Point<3>> normals(mesh.coordinates.size(), Point<3>::Zero());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Point<3> normal = area_vector(triangles[t], mesh.coordinates);
    for (const NodeIndex node : triangles[t]) normals[node] += normal;
  }
  for (auto& normal : normals)
    if (normal.squaredNorm() > 0.0) normal = unit_vector(normal);
  return normals;
}

void append_layers(VolumeCells& mesh) {
  const auto triangles = Topology(3, mesh.coordinates.size(), mesh.cells).boundary_facets();
  const auto normals = node_normals(mesh, triangles);
  const std::size_t n_inner = mesh.coordinates.size();
  std::vector<NodeIndex> below(n_inner), above(n_inner);
  for (std::size_t i = 0; i < n_inner; ++i) below[i] = static_cast<NodeIndex>(i);
  for (int layer = 1; layer <= n_layers; ++layer) {
    for (std::size_t i = 0; i < n_inner; ++i) {
      if (normals[i].squaredNorm() == 0.0) continue;
      above[i] = static_cast<NodeIndex>(mesh.coordinates.size());
      mesh.coordinates.push_back(mesh.coordinates[i] + layer_height * layer * normals[i]);
    }
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto row = triangles[t];
      mesh.cells.append(std::array<NodeIndex, 6>{below[row[0]], below[row[1]], below[row[2]],
                                                 above[row[0]], above[row[1]], above[row[2]]});
    }
    std::swap(below, above);
  }
}

/// A vessel with an arch and two branches that begin in fillets, filled with tetrahedra and wrapped
/// in six layers of thin prisms: about 35,551 tetrahedra and 80,724 prisms (thesis, Section 5.4.3).
/// Its three ends are flat, with sharp rims. Boundary nodes are fixed. Throws InputError if the
/// edge scale is not 1.
AnyMesh generate(const DomainParameters& p) {
  require_edge_scale("aorta", p.edge_scale, 1);
  VolumeCells mesh = tetrahedra();
  append_layers(mesh);
  return mesh_of(std::move(mesh), "generated vessel");
}

const RegisteredDomain registered(
    {.name = "aorta",
     .description =
         "stand-in for Section 5.4.3's mesh: about its counts, an arch with two branches",
     .dimension = 3,
     .elements = {"mixed"},
     .make = generate});

}  // namespace
}  // namespace smoothfem
