// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/tensor_grid.h"

namespace smoothfem {
namespace {

/// The grid's x-range has six layers of equal width.
constexpr int n_layers = 6;

/// Maps [0, 1] to itself so that the upper half is small: it has the size eps / 2.
double right(double eps, double y) {
  return y <= 0.5 ? (2.0 - eps) * y : 1.0 - eps * (1.0 - y);
}

/// The reverse: the lower half is small.
double left(double eps, double y) {
  return 1.0 - right(eps, 1.0 - y);
}

/// Goes from 0 to 1 for t from 0 to 1, with vanishing first and second derivatives at both ends.
double smooth_step(double t) {
  return t * t * t * (t * (6.0 * t - 15.0) + 10.0);
}

/// Where a point goes in the direction of y or z. From layer to layer the small half is below, goes
/// up, goes down within two layers, goes up, and is above. D. Kershaw, Differencing of the
/// diffusion equation in Lagrangian hydrodynamic codes, J. Comput. Phys. 39 (1981), in the smooth
/// form of the CEED benchmarks: T. Kolev et al., Efficient exascale discretizations, Int. J. High
/// Perform. Comput. Appl. 35 (2021).
double moved(double eps, double x, double y) {
  const double lower = left(eps, y), upper = right(eps, y);
  const int layer = std::min(static_cast<int>(n_layers * x), n_layers - 1);
  const double in_layer = n_layers * x - layer;
  const auto between = [](double from, double to, double t) {
    return from + (to - from) * smooth_step(t);
  };
  switch (layer) {
    case 0:
      return lower;
    case 1:
    case 4:
      return between(lower, upper, in_layer);
    case 2:
      return between(upper, lower, 0.5 * in_layer);
    case 3:
      return between(upper, lower, 0.5 * (1.0 + in_layer));
    default:
      return upper;
  }
}

/// Returns equal steps from 0 to 1.
std::vector<double> equal_steps(int n) {
  std::vector<double> steps;
  for (int i = 0; i <= n; ++i) steps.push_back(static_cast<double>(i) / n);
  return steps;
}

/// Returns the number of cells on each side: a multiple of six.
int n_cells(const DomainParameters& p, int n_at_scale_1) {
  require_edge_scale("kershaw", p.edge_scale, n_at_scale_1 / n_layers);
  return n_layers * static_cast<int>(std::lround(n_at_scale_1 / (n_layers * p.edge_scale)));
}

/// Quadrilaterals, or triangles that halve them along the diagonal of rising x and y. All have
/// positive areas, as two sides of a quadrilateral are parallel to y.
AnyMesh planar(const DomainParameters& p) {
  constexpr int n_at_scale_1 = 48;
  const int n = n_cells(p, n_at_scale_1);
  const auto steps = equal_steps(n);
  PlanarCells cells;
  for (const double y : steps)
    for (const double x : steps) cells.coordinates.emplace_back(x, moved(*p.eps, x, y));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const auto a = static_cast<NodeIndex>(i + (n + 1) * j), b = a + 1;
      const auto d = static_cast<NodeIndex>(a + static_cast<NodeIndex>(n + 1)), c = d + 1;
      if (p.elements == "quadrilaterals") {
        cells.cells.append(std::vector{a, b, c, d});
      } else {
        cells.cells.append(std::vector{a, b, c});
        cells.cells.append(std::vector{a, c, d});
      }
    }
  return mesh_of(std::move(cells), "generated kershaw");
}

/// Splits hexahedra into six tetrahedra around the diagonal of rising x, y and z.
CompressedRows<NodeIndex> tetrahedra_of(const CompressedRows<NodeIndex>& hexahedra) {
  // On each way from corner 0 to corner 6 along edges, two corners lie between.
  constexpr std::array<std::array<std::size_t, 2>, 6> between{
      {{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}}};
  CompressedRows<NodeIndex> tetrahedra;
  for (std::size_t h = 0; h < hexahedra.size(); ++h) {
    const auto corners = hexahedra[h];
    for (const auto& [i, j] : between)
      tetrahedra.append(std::vector{corners[0], corners[i], corners[j], corners[6]});
  }
  return tetrahedra;
}

/// Hexahedra, or tetrahedra that split them. All have positive volumes: their edges in the
/// directions of y and z are parallel to these.
AnyMesh volume(const DomainParameters& p) {
  constexpr int n_at_scale_1 = 24;
  const auto steps = equal_steps(n_cells(p, n_at_scale_1));
  VolumeCells cells = tensor_grid({steps, steps, steps});
  for (auto& point : cells.coordinates) {
    const double x = point.x();
    point = {x, moved(*p.eps, x, point.y()), moved(*p.eps, x, point.z())};
  }
  if (p.elements == "tetrahedra") cells.cells = tetrahedra_of(cells.cells);
  return mesh_of(std::move(cells), "generated kershaw");
}

const RegisteredDomain kershaw(
    {.name = "kershaw",
     .description =
         "Kershaw's mesh of the unit square, 48 cells on each side; eps from 1 (uniform) "
         "towards 0 (badly shaped), default 0.3",
     .dimension = 2,
     .elements = {"triangles", "quadrilaterals"},
     .eps = 0.3,
     .make = planar});
const RegisteredDomain kershaw_cube(
    {.name = "kershaw-cube",
     .description = "Kershaw's mesh of the unit cube, 24 cells on each side; eps as for kershaw",
     .dimension = 3,
     .elements = {"tetrahedra", "hexahedra"},
     .eps = 0.3,
     .make = volume});

}  // namespace
}  // namespace smoothfem
