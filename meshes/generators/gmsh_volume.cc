#include "meshes/generators/gmsh_volume.h"

#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "meshes/generators/gmsh_nodes.h"
#include "meshes/io/gmsh_session.h"

namespace smoothfem {

namespace {

constexpr int frontal_delaunay_2d = 6;  // 8 hangs on some domains
constexpr int delaunay_3d = 1;
constexpr int tetrahedron = 4;

gmsh::vectorpair add(const std::vector<Cylinder>& cylinders) {
  gmsh::vectorpair solids;
  for (const auto& c : cylinders)
    solids.emplace_back(3, gmsh::model::occ::addCylinder(c.centre.x(), c.centre.y(), c.bottom, 0.0,
                                                         0.0, c.top - c.bottom, c.radius));
  return solids;
}

void build_geometry(const std::vector<Cylinder>& joined, const std::vector<Cylinder>& removed) {
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

void build_geometry(const Polygons& polygons, double length) {
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

void set_edge_length(GmshSession& session, double length) {
  session.set_option("Mesh.CharacteristicLengthMin", length);
  session.set_option("Mesh.CharacteristicLengthMax", length);
}

VolumeCells mesh_of_model() {
  VolumeCells mesh;
  GmshNodes all = nodes_of_model();
  mesh.coordinates = std::move(all.points);
  const auto number = [&](std::size_t tag) { return all.numbers.at(tag); };
  std::vector<std::size_t> elements, nodes;
  gmsh::model::mesh::getElementsByType(tetrahedron, elements, nodes);
  for (std::size_t k = 0; k < nodes.size(); k += 4)
    mesh.cells.append(std::array<NodeIndex, 4>{number(nodes[k]), number(nodes[k + 1]),
                                               number(nodes[k + 2]), number(nodes[k + 3])});
  return mesh;
}

VolumeCells mesh_model(const std::function<void()>& build, const EdgeLengths& lengths) {
  GmshSession session;
  session.set_option("Mesh.Algorithm", frontal_delaunay_2d);
  session.set_option("Mesh.Algorithm3D", delaunay_3d);
  session.set_option("Mesh.CharacteristicLengthExtendFromBoundary", 0);
  session.set_option("Mesh.CharacteristicLengthFromPoints", 0);
  VolumeCells mesh;
  session.run("the solid cannot be meshed", [&] {
    build();
    set_edge_length(session, lengths.boundary);
    divide_curves(lengths.boundary);
    gmsh::model::mesh::generate(2);
    set_edge_length(session, lengths.inside);
    gmsh::model::mesh::generate(3);
    mesh = mesh_of_model();
  });
  return mesh;
}

}  // namespace

VolumeCells mesh_solid(const std::vector<Cylinder>& joined, const std::vector<Cylinder>& removed,
                       const EdgeLengths& lengths) {
  return mesh_model([&] { build_geometry(joined, removed); }, lengths);
}

VolumeCells mesh_extrusion(const Polygons& polygons, double length, const EdgeLengths& lengths) {
  return mesh_model([&] { build_geometry(polygons, length); }, lengths);
}

}  // namespace smoothfem
