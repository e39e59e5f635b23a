// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/gmsh_tetrahedra.h"

#include <gmsh.h>

#include <array>

#include "meshes/tools/gmsh_nodes.h"
#include "meshes/tools/gmsh_planar.h"

namespace smoothfem {

namespace {

constexpr int triangle = 2, tetrahedron = 4;  // Gmsh's numbers of the types

VolumeCells tetrahedra_of_model() {
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

/// Adds a surface of given triangles, with the points that it uses and no underlying surface.
int add_surface(const std::vector<Point<3>>& points, const CompressedRows<NodeIndex>& triangles,
                std::vector<bool>& known) {
  const int surface = gmsh::model::addDiscreteEntity(2);
  std::vector<std::size_t> tags, corners;
  std::vector<double> xyz;
  for (const NodeIndex node : triangles.entries()) {
    corners.push_back(std::size_t{node} + 1);
    if (known[node]) continue;
    known[node] = true;
    tags.push_back(std::size_t{node} + 1);
    xyz.insert(xyz.end(), points[node].begin(), points[node].end());
  }
  gmsh::model::mesh::addNodes(2, surface, tags, xyz);
  gmsh::model::mesh::addElementsByType(surface, triangle, {}, corners);
  return surface;
}

}  // namespace

void use_frontal_surfaces(GmshSession& session) {
  session.set_option("Mesh.Algorithm", static_cast<int>(TriangleAlgorithm::frontal));
  session.set_option("Mesh.CharacteristicLengthExtendFromBoundary", 0);
  session.set_option("Mesh.CharacteristicLengthFromPoints", 0);
}

void set_algorithm(GmshSession& session, TetrahedronAlgorithm algorithm) {
  session.set_option("Mesh.Algorithm3D", static_cast<int>(algorithm));
}

void set_edge_length(GmshSession& session, double length) {
  session.set_option("Mesh.CharacteristicLengthMin", length);
  session.set_option("Mesh.CharacteristicLengthMax", length);
}

VolumeCells mesh_with_tetrahedra(const std::string& name,
                                 const std::function<void(GmshSession&)>& build) {
  GmshSession session;
  use_frontal_surfaces(session);
  set_algorithm(session, TetrahedronAlgorithm::delaunay);
  VolumeCells mesh;
  session.run(name + " cannot be meshed", [&] {
    build(session);
    gmsh::model::mesh::generate(3);
    mesh = tetrahedra_of_model();
  });
  return mesh;
}

VolumeCells fill_with_tetrahedra(const std::string& name, const std::vector<Point<3>>& points,
                                 const std::vector<CompressedRows<NodeIndex>>& surfaces,
                                 double edge_length, double optimization_threshold) {
  return mesh_with_tetrahedra(name, [&](GmshSession& session) {
    session.set_option("Mesh.OptimizeThreshold", optimization_threshold);
    session.set_option("Mesh.CharacteristicLengthMax", edge_length);
    std::vector<int> loops;
    std::vector<bool> known(points.size(), false);
    for (const auto& triangles : surfaces)
      loops.push_back(gmsh::model::geo::addSurfaceLoop({add_surface(points, triangles, known)}));
    gmsh::model::geo::addVolume(loops);
    gmsh::model::geo::synchronize();
  });
}

}  // namespace smoothfem
