// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmsh.h>

#include <array>
#include <cmath>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/gmsh_tetrahedra.h"
#include "meshes/tools/tensor_grid.h"

namespace smoothfem {
namespace {

/// Along the whole cube, with edge scale 1.
constexpr int edges_a_side = 32;

/// A cube between equal coordinates, or seven eighths of it.
struct Cube {
  std::string name;
  double first, last;  ///< range of each coordinate
  bool has_corner;     ///< true: with the eighth that has the largest coordinates
};

const Cube whole{"cube", 0.0, 1.0, true};
const Cube fichera{"Fichera corner", -1.0, 1.0, false};

/// Makes n hexahedra along each side; n is even if a corner is left out.
VolumeCells hexahedra(const Cube& cube, int n) {
  std::vector<double> planes;
  for (int i = 0; i <= n; ++i) planes.push_back(cube.first + (cube.last - cube.first) * i / n);
  const auto half = static_cast<std::size_t>(n / 2);
  return tensor_grid({planes, planes, planes}, [&](std::size_t i, std::size_t j, std::size_t k) {
    return cube.has_corner || i < half || j < half || k < half;
  });
}

VolumeCells tetrahedra(const Cube& cube, int n) {
  const double side = cube.last - cube.first;
  return mesh_with_tetrahedra("the " + cube.name, [&](GmshSession& session) {
    namespace occ = gmsh::model::occ;
    const int box = occ::addBox(cube.first, cube.first, cube.first, side, side, side);
    if (!cube.has_corner) {
      const double middle = cube.first + 0.5 * side, half = 0.5 * side;
      const int corner = occ::addBox(middle, middle, middle, half, half, half);
      gmsh::vectorpair rest;
      std::vector<gmsh::vectorpair> origin;
      occ::cut({{3, box}}, {{3, corner}}, rest, origin);
    }
    occ::synchronize();
    set_edge_length(session, side / n);
  });
}

/// Uniform meshes: tetrahedra by Gmsh with edges of equal length, hexahedra by a grid.
AnyMesh generate(const Cube& cube, const DomainParameters& p) {
  constexpr int largest_edge_scale = 8;
  require_edge_scale(cube.name, p.edge_scale, largest_edge_scale);
  const int n = 2 * static_cast<int>(std::lround(edges_a_side / (2.0 * p.edge_scale)));
  return mesh_of(p.elements == "hexahedra" ? hexahedra(cube, n) : tetrahedra(cube, n),
                 "generated " + cube.name);
}

const RegisteredDomain cube(
    {.name = "cube",
     .description = "unit cube, 32 edges on each side, for solutions with fronts, layers and peaks",
     .dimension = 3,
     .elements = {"tetrahedra", "hexahedra"},
     .make = [](const DomainParameters& p) { return generate(whole, p); },
     .boundary = [](const DomainParameters&) { return flat_boundary<3>(); }});
const RegisteredDomain fichera_corner(
    {.name = "fichera",
     .description =
         "seven unit cubes around the re-entrant corner at the origin, 16 edges per unit length",
     .dimension = 3,
     .elements = {"tetrahedra", "hexahedra"},
     .make = [](const DomainParameters& p) { return generate(fichera, p); },
     .boundary = [](const DomainParameters&) { return flat_boundary<3>(); }});

}  // namespace
}  // namespace smoothfem
