// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/gmsh_planar.h"

#include <gmsh.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

#include "meshes/tools/gmsh_nodes.h"
#include "meshes/tools/gmsh_session.h"
#include "meshes/tools/grid_region.h"
#include "smoothing/base/input_error.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/surface/nearest_point.h"

namespace smoothfem {

namespace {

constexpr int blossom = 1;

double distance(const Polygons& polygons, const Point<2>& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& polygon : polygons)
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const auto& next = polygon[(k + 1) % polygon.size()];
      least = std::min(least, (p - nearest_on_segment<2>(p, polygon[k], next)).norm());
    }
  return least;
}

/// Returns grid points that are far enough from the boundary for good cells in between.
std::vector<Point<2>> grid_points(const Polygons& polygons, double spacing) {
  constexpr double clearance = 0.7;
  std::vector<Point<2>> points = GridRegion(polygons, spacing).cells().coordinates;
  std::erase_if(points,
                [&](const Point<2>& p) { return distance(polygons, p) < clearance * spacing; });
  return points;
}

/// Makes one point for each corner, one undivided line for each edge, and one plane surface with
/// the inner points in it.
void build_geometry(const Polygons& polygons, const std::vector<Point<2>>& inner_points) {
  std::vector<int> loops;
  int point = 0;
  for (const auto& polygon : polygons) {
    const int first = point + 1, n = static_cast<int>(polygon.size());
    for (const auto& corner : polygon)
      gmsh::model::geo::addPoint(corner.x(), corner.y(), 0.0, 0.0, ++point);
    for (int i = 0; i < n; ++i)
      gmsh::model::geo::addLine(first + i, first + (i + 1) % n, first + i);
    std::vector<int> lines(polygon.size());
    std::iota(lines.begin(), lines.end(), first);
    loops.push_back(gmsh::model::geo::addCurveLoop(lines));
  }
  gmsh::model::geo::addPlaneSurface(loops, 1);
  std::vector<int> embedded;
  for (const auto& p : inner_points)
    embedded.push_back(gmsh::model::geo::addPoint(p.x(), p.y(), 0.0));
  gmsh::model::geo::synchronize();
  gmsh::model::mesh::embed(0, embedded, 2, 1);
  for (int line = 1; line <= point; ++line) gmsh::model::mesh::setTransfiniteCurve(line, 2);
}

void set_options(GmshSession& session, double edge_length, bool recombine,
                 const RegionMeshing& meshing) {
  session.set_option("Mesh.Algorithm", static_cast<int>(meshing.algorithm));
  session.set_option("Mesh.CharacteristicLengthExtendFromBoundary", meshing.is_graded ? 1 : 0);
  session.set_option("Mesh.CharacteristicLengthFromPoints", 0);
  session.set_option("Mesh.CharacteristicLengthMin", meshing.is_graded ? 0.0 : edge_length);
  session.set_option("Mesh.CharacteristicLengthMax", edge_length);
  session.set_option("Mesh.RecombineAll", recombine ? 1 : 0);
  session.set_option("Mesh.RecombinationAlgorithm", blossom);
}

double signed_area(const PlanarCells& mesh) {
  double twice = 0.0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto row = mesh.cells[c];
    for (std::size_t k = 0; k < row.size(); ++k)
      twice += cross(mesh.coordinates[row[k]], mesh.coordinates[row[(k + 1) % row.size()]]);
  }
  return 0.5 * twice;
}

void turn_over(PlanarCells& mesh) {
  CompressedRows<NodeIndex> turned;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto row = mesh.cells[c];
    turned.append(std::vector<NodeIndex>(row.rbegin(), row.rend()));
  }
  mesh.cells = std::move(turned);
}

PlanarCells mesh_of_model() {
  PlanarCells mesh;
  const GmshNodes all = nodes_of_model();
  for (const auto& point : all.points) mesh.coordinates.emplace_back(point.x(), point.y());
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> elements, nodes;
  gmsh::model::mesh::getElements(types, elements, nodes, 2);
  for (std::size_t t = 0; t < types.size(); ++t) {
    const std::size_t n = elements[t].empty() ? 0 : nodes[t].size() / elements[t].size();
    std::vector<NodeIndex> row(n);
    for (std::size_t e = 0; e < elements[t].size(); ++e) {
      for (std::size_t k = 0; k < n; ++k) row[k] = all.numbers.at(nodes[t][e * n + k]);
      mesh.cells.append(row);
    }
  }
  if (signed_area(mesh) < 0.0) turn_over(mesh);
  return mesh;
}

}  // namespace

PlanarCells mesh_region(const Polygons& polygons, double edge_length, PlanarPattern pattern,
                        const RegionMeshing& meshing) {
  constexpr double sparse = 2.0;  // adds points only where the grid leaves gaps
  const bool in_rows = pattern == PlanarPattern::quadrilaterals_in_rows;
  GmshSession session;
  set_options(session, (in_rows ? sparse : 1.0) * edge_length, pattern != PlanarPattern::triangles,
              meshing);
  PlanarCells mesh;
  session.run("the region cannot be meshed", [&] {
    build_geometry(polygons,
                   in_rows ? grid_points(polygons, edge_length) : std::vector<Point<2>>{});
    gmsh::model::mesh::generate(2);
    mesh = mesh_of_model();
  });
  return mesh;
}

}  // namespace smoothfem
