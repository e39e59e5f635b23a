// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmsh.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

#include "meshes/distortion/counter_random.h"
#include "meshes/domains/catalogue.h"
#include "meshes/tools/delaunay.h"
#include "meshes/tools/gmsh_nodes.h"
#include "meshes/tools/gmsh_tetrahedra.h"

namespace smoothfem {
namespace {

constexpr std::size_t n_inner = 1441;
constexpr double boundary_edge = 0.315;  // gives about 1,228 boundary nodes
constexpr double margin = 0.15;          // distance of random nodes from the boundary
constexpr double shaft_height = 10.0, tip_radius = 0.5, top_radius = 1.4;
const Point<3> neck_foot(0.0, 0.0, 9.0), head_centre(2.3, 0.0, 12.1);
constexpr double neck_radius = 0.7, head_radius = 1.4;

/// Returns the boundary's nodes.
std::vector<Point<3>> boundary_nodes() {
  GmshSession session;
  std::vector<Point<3>> nodes;
  session.run("the stem cannot be meshed", [&] {
    namespace occ = gmsh::model::occ;
    const Point<3> neck = head_centre - neck_foot;
    gmsh::vectorpair whole;
    std::vector<gmsh::vectorpair> origin;
    occ::fuse({{3, occ::addCone(0, 0, 0, 0, 0, shaft_height, tip_radius, top_radius)}},
              {{3, occ::addCylinder(neck_foot.x(), neck_foot.y(), neck_foot.z(), neck.x(), neck.y(),
                                    neck.z(), neck_radius)},
               {3, occ::addSphere(head_centre.x(), head_centre.y(), head_centre.z(), head_radius)}},
              whole, origin);
    occ::synchronize();
    set_edge_length(session, boundary_edge);
    gmsh::model::mesh::generate(2);
    nodes = nodes_of_model().points;
  });
  return nodes;
}

/// True if a point lies inside, at least `depth` below the boundary of one of the parts.
bool is_inside(const Point<3>& p, double depth) {
  const double height = p.z() / shaft_height;  // as a fraction
  const bool in_shaft =
      p.z() > depth && p.z() < shaft_height - depth &&
      std::hypot(p.x(), p.y()) < tip_radius + height * (top_radius - tip_radius) - depth;
  const Point<3> axis = head_centre - neck_foot;
  const double along = axis.dot(p - neck_foot) / axis.squaredNorm();
  const bool in_neck =
      along > 0.0 && along < 1.0 && (p - neck_foot - along * axis).norm() < neck_radius - depth;
  return in_shaft || in_neck || (p - head_centre).norm() < head_radius - depth;
}

std::vector<Point<3>> random_nodes(std::uint64_t seed) {
  const Point<3> low(-top_radius, -top_radius, 0.0);
  const Point<3> high = head_centre + Point<3>::Constant(head_radius);
  std::vector<Point<3>> nodes;
  for (std::uint64_t attempt = 0; nodes.size() < n_inner; ++attempt) {
    SplitMix64 random = counter_random(seed, attempt, 0);
    Point<3> p;
    for (int d = 0; d < 3; ++d) p[d] = low[d] + random.uniform() * (high[d] - low[d]);
    if (is_inside(p, margin)) nodes.push_back(p);
  }
  return nodes;
}

/// A hip stem: a tapered shaft with a neck and a ball on it. It has 1,228 boundary nodes as in the
/// thesis (Section 5.2.2, within 2 %), and 1,441 random nodes inside. Boundary nodes are fixed.
/// Throws InputError if the edge scale is not 1.
AnyMesh generate(const DomainParameters& p) {
  require_edge_scale("prosthesis", p.edge_scale, 1);
  std::vector<Point<3>> nodes = boundary_nodes();
  const auto inner = random_nodes(p.seed);
  nodes.insert(nodes.end(), inner.begin(), inner.end());
  // The Delaunay mesh fills the convex hull: cells outside are removed, and so are flat ones on the
  // surface.
  constexpr double flat = 0.02;
  return mesh_of(delaunay_mesh(std::move(nodes), "the stem",
                               [](const Point<3>& centre, double quality) {
                                 return is_inside(centre, 0.0) && quality > flat;
                               }),
                 "generated stem");
}

const RegisteredDomain registered(
    {.name = "prosthesis",
     .description =
         "stand-in for Section 5.2.2's mesh: its counts of nodes, random inside, a simpler stem",
     .dimension = 3,
     .elements = {"tetrahedra"},
     .random_elements = {"tetrahedra"},
     .make = generate});

}  // namespace
}  // namespace smoothfem
