// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/gmsh_volume.h"

#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "meshes/tools/gmsh_nodes.h"
#include "meshes/tools/gmsh_tetrahedra.h"
#include "meshes/tools/netgen_tetrahedra.h"

namespace smoothfem {

namespace {

gmsh::vectorpair add(const std::vector<Cylinder>& cylinders) {
  gmsh::vectorpair solids;
  for (const auto& c : cylinders)
    solids.emplace_back(3, gmsh::model::occ::addCylinder(c.centre.x(), c.centre.y(), c.bottom, 0.0,
                                                         0.0, c.top - c.bottom, c.radius));
  return solids;
}

void add_extrusion(const Polygons& polygons, double length) {
  std::vector<int> loops;
  for (const auto& polygon : polygons) {
    std::vector<int> points, lines;
    for (const auto& corner : polygon)
      points.push_back(gmsh::model::occ::addPoint(corner.x(), corner.y(), 0.0));
    for (std::size_t i = 0; i < points.size(); ++i)
      lines.push_back(gmsh::model::occ::addLine(points[i], points[(i + 1) % points.size()]));
    loops.push_back(gmsh::model::occ::addCurveLoop(lines));
  }
  gmsh::vectorpair swept;
  gmsh::model::occ::extrude({{2, gmsh::model::occ::addPlaneSurface(loops)}}, 0.0, 0.0, length,
                            swept);
  gmsh::model::occ::synchronize();
}

void divide_curves(double edge_length) {
  gmsh::vectorpair curves;
  gmsh::model::getEntities(curves, 1);
  for (const auto& [dim, tag] : curves) {
    std::string type;
    gmsh::model::getType(dim, tag, type);
    double length = 0.0;
    gmsh::model::occ::getMass(dim, tag, length);
    const int multiple = type == "Circle" ? 4 : 1;
    const int n =
        multiple * std::max(1, static_cast<int>(std::lround(length / edge_length / multiple)));
    gmsh::model::mesh::setTransfiniteCurve(tag, n + 1);
  }
}

/// Returns the triangles around the model's volume.
ClosedSurface surface_of_model() {
  ClosedSurface surface;
  GmshNodes all = nodes_of_model();
  surface.points = std::move(all.points);
  gmsh::vectorpair volumes, faces;
  gmsh::model::getEntities(volumes, 3);
  gmsh::model::getBoundary(volumes, faces, true, false);
  constexpr int triangle = 2;  // Gmsh's number
  for (const auto& [dim, tag] : faces) {
    std::vector<std::size_t> elements, nodes;
    gmsh::model::mesh::getElementsByType(triangle, elements, nodes, tag);
    for (std::size_t k = 0; k < nodes.size(); k += 3)
      surface.triangles.append(std::array<NodeIndex, 3>{
          all.numbers.at(nodes[k]), all.numbers.at(nodes[k + 1]), all.numbers.at(nodes[k + 2])});
  }
  return surface;
}

/// Makes the model's surface mesh.
void mesh_surface(GmshSession& session, const std::function<void()>& build, double edge_length) {
  build();
  set_edge_length(session, edge_length);
  divide_curves(edge_length);
  gmsh::model::mesh::generate(2);
}

VolumeCells mesh_model(const std::function<void()>& build, const EdgeLengths& lengths,
                       TetrahedronAlgorithm algorithm = TetrahedronAlgorithm::delaunay) {
  if (algorithm == TetrahedronAlgorithm::netgen) {
    GmshSession session;
    ClosedSurface surface;
    session.run("the solid cannot be meshed", [&] {
      use_frontal_surfaces(session);
      mesh_surface(session, build, lengths.boundary);
      surface = surface_of_model();
    });
    return fill_by_netgen(surface, lengths.inside);
  }
  return mesh_with_tetrahedra("the solid", [&](GmshSession& session) {
    set_algorithm(session, algorithm);
    mesh_surface(session, build, lengths.boundary);
    set_edge_length(session, lengths.inside);
  });
}

}  // namespace

void add_solid(const std::vector<Cylinder>& joined, const std::vector<Cylinder>& removed) {
  gmsh::vectorpair solid = add(joined);
  std::vector<gmsh::vectorpair> origin;
  if (solid.size() > 1) {
    gmsh::vectorpair whole;
    gmsh::model::occ::fuse({solid.front()}, {solid.begin() + 1, solid.end()}, whole, origin);
    solid = whole;
  }
  if (!removed.empty()) {
    gmsh::vectorpair rest;
    gmsh::model::occ::cut(solid, add(removed), rest, origin);
  }
  gmsh::model::occ::synchronize();
}

VolumeCells mesh_solid(const std::vector<Cylinder>& joined, const std::vector<Cylinder>& removed,
                       const EdgeLengths& lengths) {
  return mesh_model([&] { add_solid(joined, removed); }, lengths);
}

VolumeCells mesh_ball(const EdgeLengths& lengths) {
  return mesh_model(
      [] {
        gmsh::model::occ::addSphere(0.0, 0.0, 0.0, 1.0);
        gmsh::model::occ::synchronize();
      },
      lengths);
}

VolumeCells mesh_extrusion(const Polygons& polygons, double length, const EdgeLengths& lengths,
                           TetrahedronAlgorithm algorithm) {
  return mesh_model([&] { add_extrusion(polygons, length); }, lengths, algorithm);
}

}  // namespace smoothfem
