// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/gmsh_tetrahedra.h"
#include "meshes/tools/gmsh_volume.h"

namespace smoothfem {
namespace {

constexpr double flange_radius = 6.0, flange_height = 1.2;
constexpr double shaft_radius = 2.0, shaft_end = 9.0, bore_radius = 0.7;
constexpr int n_holes = 16;  // with the bore: genus 17
constexpr double hole_circle = 4.4, hole_radius = 0.12;
/// Edge lengths at the holes and far from them; their ratio is that of the lengths in the mesh.
constexpr double small_edge = 0.00378, large_edge = 0.621;
constexpr double max_edge = 1.2;  // longer ones do not fit the flange
/// Growth of the edge length with the distance from a hole. It is so steep that the quality of
/// triangles and tetrahedra is about as low as in the thesis.
constexpr double growth = 0.5;

void add_axle() {
  const Point<2> axis(0, 0);
  std::vector<Cylinder> removed{{axis, bore_radius, -1, shaft_end + 1}};
  for (int i = 0; i < n_holes; ++i)
    removed.push_back({on_circle(axis, hole_circle, 2.0 * std::numbers::pi * i / n_holes),
                       hole_radius, -1, flange_height + 1});
  add_solid({{axis, flange_radius, 0, flange_height}, {axis, shaft_radius, 0, shaft_end}}, removed);
}

/// Returns curves of the model.
std::vector<double> curves_of_holes() {
  gmsh::vectorpair curves;
  gmsh::model::getEntities(curves, 1);
  std::vector<double> small;
  for (const auto& [dim, tag] : curves) {
    double x0 = 0, y0 = 0, z0 = 0, x1 = 0, y1 = 0, z1 = 0;
    gmsh::model::getBoundingBox(dim, tag, x0, y0, z0, x1, y1, z1);
    const bool at_hole = std::hypot(x1 - x0, y1 - y0) < 4.0 * hole_radius &&
                         std::hypot(x0, y0) > shaft_radius + hole_radius &&
                         std::hypot(x0, y0) < flange_radius - 3.0 * hole_radius;
    if (at_hole) small.push_back(tag);
  }
  return small;
}

/// Edges grow with the distance from the holes' curves.
void set_edge_lengths(GmshSession& session, const std::vector<double>& holes, double edge_scale) {
  namespace field = gmsh::model::mesh::field;
  const double longest = std::min(edge_scale * large_edge, max_edge);
  const int distance = field::add("Distance");
  field::setNumbers(distance, "EdgesList", holes);
  field::setNumber(distance, "NNodesByEdge", 100);
  const int length = field::add("Threshold");
  field::setNumber(length, "IField", distance);
  field::setNumber(length, "LcMin", edge_scale * small_edge);
  field::setNumber(length, "LcMax", longest);
  field::setNumber(length, "DistMin", 0.0);
  field::setNumber(length, "DistMax", (large_edge - small_edge) / growth);
  field::setAsBackgroundMesh(length);
  session.set_option("Mesh.CharacteristicLengthMin", 0.0);
  session.set_option("Mesh.CharacteristicLengthMax", longest);
}

/// A stub axle of genus 17: a shaft and a flange with a bore along the axis and 16 holes. Its
/// tetrahedra are small at the holes and large elsewhere (thesis, Section 5.2.3). Edge scale 1:
/// about 400,128 tetrahedra; up to 6. Boundary nodes are fixed. Throws InputError for an edge scale
/// out of range.
AnyMesh generate(const DomainParameters& p) {
  require_edge_scale("axle", p.edge_scale, 6);
  VolumeCells mesh = mesh_with_tetrahedra("the axle", [&](GmshSession& session) {
    // The thesis does not use its mesher's optimizer either.
    session.set_option("Mesh.Optimize", 0);
    add_axle();
    set_edge_lengths(session, curves_of_holes(), p.edge_scale);
  });
  return mesh_of(std::move(mesh), "generated axle");
}

const RegisteredDomain registered(
    {.name = "axle",
     .description =
         "stand-in for Section 5.2.3's meshes: their genus and size, graded towards 16 holes",
     .dimension = 3,
     .elements = {"tetrahedra"},
     .make = generate});

}  // namespace
}  // namespace smoothfem
