// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmsh.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/gmsh_planar.h"
#include "meshes/tools/gmsh_tetrahedra.h"
#include "meshes/tools/tensor_grid.h"
#include "smoothing/mesh/fixed_nodes.h"

namespace smoothfem {
namespace {

/// Along a side of the square or cube, with edge scale 1.
constexpr int planar_edges = 64, volume_edges = 24;

/// Gives cells the tags 1 and 2 of two groups. is_first: of the mean of a cell's nodes.
template <int dim, class IsFirst>
AnyMesh with_two_groups(MeshCells<dim> cells, const std::string& name,
                        const std::array<std::string, 2>& groups, const IsFirst& is_first) {
  const Mesh<dim> plain = mesh_of(std::move(cells), name);
  MeshLabels labels;
  labels.names = {{{dim, 1}, groups[0]}, {{dim, 2}, groups[1]}};
  for (CellIndex c = 0; c < plain.n_cells(); ++c) {
    const auto nodes = plain.topology().cell_nodes(c);
    Point<dim> sum = Point<dim>::Zero();
    for (const NodeIndex node : nodes) sum += plain.coordinates()[node];
    labels.cell_tags.push_back(is_first(Point<dim>(sum / static_cast<double>(nodes.size()))) ? 1
                                                                                             : 2);
  }
  auto topology = std::make_shared<const Topology>(dim, plain.n_nodes(), plain.topology().cells(),
                                                   std::nullopt, std::move(labels));
  auto reasons = topology->fixed_reasons();
  add_implied_reasons(*topology, reasons);
  return with_fixed_nodes(Mesh<dim>(std::move(topology), plain.copied_coordinates()),
                          std::move(reasons));
}

template <int dim>
AnyMesh with_halves(MeshCells<dim> cells, const std::string& name) {
  return with_two_groups(std::move(cells), name, {"left", "right"},
                         [](const Point<dim>& p) { return p.x() < 0.5; });
}

/// Returns the corner points and n edges on each side of a rectangle.
std::vector<Point<2>> rectangle(const Point<2>& low, const Point<2>& high, int n_x, int n_y) {
  std::vector<Point<2>> points;
  for (int i = 0; i < n_x; ++i)
    points.emplace_back(std::lerp(low.x(), high.x(), i / double(n_x)), low.y());
  for (int i = 0; i < n_y; ++i)
    points.emplace_back(high.x(), std::lerp(low.y(), high.y(), i / double(n_y)));
  for (int i = 0; i < n_x; ++i)
    points.emplace_back(std::lerp(high.x(), low.x(), i / double(n_x)), high.y());
  for (int i = 0; i < n_y; ++i)
    points.emplace_back(low.x(), std::lerp(high.y(), low.y(), i / double(n_y)));
  return points;
}

/// Joins meshes of two regions in their common nodes.
PlanarCells joined(const PlanarCells& first, const PlanarCells& second) {
  constexpr double digits = 1e9;
  PlanarCells both = first;
  std::map<std::pair<long, long>, NodeIndex> known;
  const auto key = [](const Point<2>& p) {
    return std::pair(std::lround(digits * p.x()), std::lround(digits * p.y()));
  };
  for (NodeIndex i = 0; i < first.coordinates.size(); ++i) known[key(first.coordinates[i])] = i;
  std::vector<NodeIndex> numbers;
  for (const auto& p : second.coordinates) {
    const auto [found, is_new] =
        known.try_emplace(key(p), static_cast<NodeIndex>(both.coordinates.size()));
    if (is_new) both.coordinates.push_back(p);
    numbers.push_back(found->second);
  }
  std::vector<NodeIndex> row;
  for (std::size_t c = 0; c < second.cells.size(); ++c) {
    row.clear();
    for (const NodeIndex node : second.cells[c]) row.push_back(numbers[node]);
    both.cells.append(row);
  }
  return both;
}

/// Returns n x n squares.
PlanarCells grid(int n) {
  PlanarCells cells;
  const auto width = static_cast<NodeIndex>(n + 1);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) cells.coordinates.emplace_back(i / double(n), j / double(n));
  for (NodeIndex j = 0; j + 1 < width; ++j)
    for (NodeIndex i = 0; i + 1 < width; ++i) {
      const NodeIndex a = j * width + i;
      cells.cells.append(std::vector{a, a + 1, a + width + 1, a + width});
    }
  return cells;
}

AnyMesh square_halves(const DomainParameters& p) {
  const std::string name = "square of two halves";
  require_edge_scale(name, p.edge_scale, 16);
  const int half = static_cast<int>(std::lround(0.5 * planar_edges / p.edge_scale));
  if (p.elements == "quadrilaterals") return with_halves<2>(grid(2 * half), "generated " + name);
  const auto region = [&](double low, double high) {
    return mesh_region({rectangle({low, 0.0}, {high, 1.0}, half, 2 * half)}, 0.5 / half,
                       PlanarPattern::triangles);
  };
  return with_halves<2>(joined(region(0.0, 0.5), region(0.5, 1.0)), "generated " + name);
}

AnyMesh square_with_disc(const DomainParameters& p) {
  const std::string name = "square with a disc";
  require_edge_scale(name, p.edge_scale, 8);
  constexpr double radius = 0.3;
  const int n = static_cast<int>(std::lround(planar_edges / p.edge_scale));
  const auto n_around = static_cast<int>(std::lround(2.0 * std::numbers::pi * radius * n));
  std::vector<Point<2>> circle;
  for (int i = 0; i < n_around; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / n_around;
    circle.emplace_back(0.5 + radius * std::cos(angle), 0.5 + radius * std::sin(angle));
  }
  const auto region = [&](const Polygons& polygons) {
    return mesh_region(polygons, 1.0 / n, PlanarPattern::triangles);
  };
  return with_two_groups<2>(
      joined(region({circle}), region({rectangle({0.0, 0.0}, {1.0, 1.0}, n, n), circle})),
      "generated " + name, {"disc", "rest"},
      [](const Point<2>& q) { return (q - Point<2>(0.5, 0.5)).norm() < radius; });
}

AnyMesh cube_halves(const DomainParameters& p) {
  const std::string name = "cube of two halves";
  require_edge_scale(name, p.edge_scale, 8);
  const int half = static_cast<int>(std::lround(0.5 * volume_edges / p.edge_scale));
  if (p.elements == "hexahedra") {
    std::vector<double> planes;
    for (int i = 0; i <= 2 * half; ++i) planes.push_back(0.5 * i / half);
    return with_halves<3>(tensor_grid({planes, planes, planes}), "generated " + name);
  }
  return with_halves<3>(
      mesh_with_tetrahedra("the " + name,
                           [&](GmshSession& session) {
                             namespace occ = gmsh::model::occ;
                             const int left = occ::addBox(0.0, 0.0, 0.0, 0.5, 1.0, 1.0);
                             const int right = occ::addBox(0.5, 0.0, 0.0, 0.5, 1.0, 1.0);
                             gmsh::vectorpair both;
                             std::vector<gmsh::vectorpair> origin;
                             occ::fragment({{3, left}}, {{3, right}}, both, origin);
                             occ::synchronize();
                             set_edge_length(session, 0.5 / half);
                           }),
      "generated " + name);
}

const RegisteredDomain square(
    {.name = "square-halves",
     .description = "unit square, 64 edges on each side, with the groups left and right of x = 1/2",
     .dimension = 2,
     .elements = {"triangles", "quadrilaterals"},
     .has_groups = true,
     .make = square_halves});
const RegisteredDomain disc(
    {.name = "square-disc",
     .description =
         "unit square, 64 edges on each side, with the groups disc (radius 0.3) and rest",
     .dimension = 2,
     .elements = {"triangles"},
     .has_groups = true,
     .make = square_with_disc});
const RegisteredDomain cube(
    {.name = "cube-halves",
     .description = "unit cube, 24 edges on each side, with the groups left and right of x = 1/2",
     .dimension = 3,
     .elements = {"tetrahedra", "hexahedra"},
     .has_groups = true,
     .make = cube_halves});

}  // namespace
}  // namespace smoothfem
