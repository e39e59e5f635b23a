// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/gmsh_volume.h"

namespace smoothfem {
namespace {

/// The boundary nodes of the inner cube, and its copies on the way to the sphere.
constexpr double inner_half_width = 0.45;

/// Hexahedra: n^3 in a cube, and n_layers between it and the sphere.
class CubeInBall {
 public:
  CubeInBall(int n, int n_layers) : n_(n), n_layers_(n_layers) {}

  VolumeCells made() && {
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j < n_; ++j)
        for (int k = 0; k < n_; ++k)
          append([&](int a, int b, int c) { return node({i + a, j + b, k + c}, 0); });
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {0, n_})
        for (int layer = 0; layer < n_layers_; ++layer)
          for (int i = 0; i < n_; ++i)
            for (int j = 0; j < n_; ++j)
              append([&](int a, int b, int c) {
                // Seen from outside, both directions along the face turn counterclockwise.
                Place place;
                place[axis] = side;
                place[(axis + (side == 0 ? 2 : 1)) % 3] = i + a;
                place[(axis + (side == 0 ? 1 : 2)) % 3] = j + b;
                return node(place, layer + c);
              });
    return std::move(cells_);
  }

 private:
  using Place = std::array<int, 3>;

  /// at(a, b, c): the corner with these coordinates in the unit cube.
  template <class At>
  void append(const At& at) {
    cells_.cells.append(std::array<NodeIndex, 8>{at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0),
                                                 at(0, 0, 1), at(1, 0, 1), at(1, 1, 1),
                                                 at(0, 1, 1)});
  }

  /// Returns the node of a place in the cube; of a place on its surface, the one in a layer.
  NodeIndex node(const Place& place, int layer) {
    const auto [found, is_new] =
        numbers_.try_emplace({place, layer}, static_cast<NodeIndex>(cells_.coordinates.size()));
    if (is_new) cells_.coordinates.push_back(position(place, layer));
    return found->second;
  }

  Point<3> position(const Place& place, int layer) const {
    Point<3> in_cube, direction;
    for (int d = 0; d < 3; ++d) {
      in_cube[d] = 2.0 * place[static_cast<std::size_t>(d)] / n_ - 1.0;
      direction[d] = std::tan(0.25 * std::numbers::pi * in_cube[d]);  // equal angles on the sphere
    }
    if (layer == 0) return inner_half_width * in_cube;
    const double t = static_cast<double>(layer) / n_layers_;
    return (1.0 - t) * inner_half_width * in_cube + t * direction.normalized();
  }

  int n_, n_layers_;
  VolumeCells cells_;
  std::map<std::pair<Place, int>, NodeIndex> numbers_;
};

AnyMesh generate(const DomainParameters& p) {
  constexpr double n_nodes = 1e5;
  constexpr int largest_edge_scale = 16;
  require_edge_scale("ball", p.edge_scale, largest_edge_scale);
  if (p.elements == "hexahedra") {
    const int n =
        std::max(2, static_cast<int>(std::lround(std::cbrt(n_nodes / 4.0) / p.edge_scale)));
    return mesh_of(CubeInBall(n, std::max(1, n / 2)).made(), "generated ball");
  }
  const double volume = 4.0 / 3.0 * std::numbers::pi;
  const double edge_length = p.edge_scale * std::cbrt(std::numbers::sqrt2 * volume / n_nodes);
  return mesh_of(mesh_ball({1.25 * edge_length, 0.8 * edge_length}), "generated ball");
}

const RegisteredDomain registered({.name = "ball",
                                   .description = "ball of radius 1",
                                   .dimension = 3,
                                   .elements = {"tetrahedra", "hexahedra"},
                                   .make = generate,
                                   .boundary = [](const DomainParameters&) -> AnyOntoBoundary {
                                     return OntoBoundary<3>([](std::span<const Point<3>>,
                                                               const Point<3>& point) -> Point<3> {
                                       return point.normalized();
                                     });
                                   }});

}  // namespace
}  // namespace smoothfem
