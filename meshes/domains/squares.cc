// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <functional>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/gmsh_planar.h"

namespace smoothfem {
namespace {

/// Cells along an edge with edge scale 1.
constexpr int cells_per_unit = 96;

/// A region of unit squares whose corners have integer coordinates.
struct Squares {
  std::string name;
  std::vector<Point<2>> corners;  ///< of its outline, counterclockwise
  int first, last;                ///< it lies within [first, last]^2
  std::function<bool(const Point<2>&)> contains;
};

const Squares unit_square{
    "square", {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0, 1, [](const Point<2>&) { return true; }};
const Squares l_shape{
    "L-shape", {{0, 0}, {1, 0}, {1, 1}, {-1, 1}, {-1, -1}, {0, -1}}, -1, 1, [](const Point<2>& p) {
      return !(p.x() > 0.0 && p.y() < 0.0);
    }};

/// The outline with n edges per unit length.
std::vector<Point<2>> polygon(const Squares& squares, int n) {
  std::vector<Point<2>> points;
  for (std::size_t k = 0; k < squares.corners.size(); ++k) {
    const Point<2>& corner = squares.corners[k];
    const Point<2> side = squares.corners[(k + 1) % squares.corners.size()] - corner;
    const int n_edges = n * static_cast<int>(std::lround(side.norm()));
    for (int i = 0; i < n_edges; ++i) points.push_back(corner + side * i / n_edges);
  }
  return points;
}

/// A grid with n squares per unit length.
PlanarCells grid(const Squares& squares, int n) {
  const int n_lines = n * (squares.last - squares.first) + 1;
  const auto at = [&](double i, double j) -> Point<2> {
    return {squares.first + i / n, squares.first + j / n};
  };
  PlanarCells cells;
  std::vector<NodeIndex> numbers(static_cast<std::size_t>(n_lines * n_lines), UINT32_MAX);
  const auto node = [&](int i, int j) {
    auto& number = numbers[static_cast<std::size_t>(i + n_lines * j)];
    if (number == UINT32_MAX) {
      number = static_cast<NodeIndex>(cells.coordinates.size());
      cells.coordinates.push_back(at(i, j));
    }
    return number;
  };
  for (int j = 0; j + 1 < n_lines; ++j)
    for (int i = 0; i + 1 < n_lines; ++i)
      if (squares.contains(at(i + 0.5, j + 0.5)))
        cells.cells.append(
            std::vector{node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
  return cells;
}

/// Uniform meshes: triangles by Gmsh between edges of equal length, quadrilaterals by a grid.
AnyMesh generate(const Squares& squares, const DomainParameters& p) {
  constexpr int largest_edge_scale = 24;
  require_edge_scale(squares.name, p.edge_scale, largest_edge_scale);
  const int n = static_cast<int>(std::lround(cells_per_unit / p.edge_scale));
  return mesh_of(p.elements == "quadrilaterals"
                     ? grid(squares, n)
                     : mesh_region({polygon(squares, n)}, 1.0 / n, PlanarPattern::triangles),
                 "generated " + squares.name);
}

const RegisteredDomain square(
    {.name = "square",
     .description =
         "unit square, 96 edges on each side, for solutions with fronts, layers and peaks",
     .dimension = 2,
     .elements = {"triangles", "quadrilaterals"},
     .make = [](const DomainParameters& p) { return generate(unit_square, p); },
     .boundary = [](const DomainParameters&) { return flat_boundary<2>(); }});
const RegisteredDomain l(
    {.name = "l-shape",
     .description =
         "three unit squares around the re-entrant corner at the origin, 96 edges per unit length",
     .dimension = 2,
     .elements = {"triangles", "quadrilaterals"},
     .make = [](const DomainParameters& p) { return generate(l_shape, p); },
     .boundary = [](const DomainParameters&) { return flat_boundary<2>(); }});

}  // namespace
}  // namespace smoothfem
