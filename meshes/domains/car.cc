// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/tensor_grid.h"

namespace smoothfem {
namespace {

// Metres. The flow runs along x, z is up; the road is at z = 0.
constexpr double inlet = -4.0, outlet = 12.0, side = 5.0, sky = 5.0;
struct Body {
  static constexpr double front = 0.0, windscreen = 1.3, rear_window = 3.3, rear = 4.2;
  static constexpr double half_width = 0.8, floor = 0.2, bonnet = 0.8, roof = 1.4;
};

/// Widths of cells, from a thin layer on, each `growth` times the one before, up to the widest. The
/// three unknowns give the thesis' number of cells and its least and mean quality.
struct Layers {
  double thinnest = 0.00063, growth = 2.82, widest = 0.0787;
};

/// A plane between pieces of an axis, and whether layers are thin there.
struct Plane {
  double coordinate;
  bool is_thin;
};

/// The fewest layers that reach from one plane to the next, shrunk to fit.
std::vector<double> widths(const Plane& from, const Plane& to, const Layers& layers) {
  const double length = to.coordinate - from.coordinate;
  std::vector<double> widths;
  double sum = 0.0;
  for (int n = 1; sum < length; ++n) {
    widths.clear();
    sum = 0.0;
    for (int i = 0; i < n; ++i) {
      double width = layers.widest;
      if (from.is_thin) width = std::min(width, layers.thinnest * std::pow(layers.growth, i));
      if (to.is_thin) width = std::min(width, layers.thinnest * std::pow(layers.growth, n - 1 - i));
      widths.push_back(width);
      sum += width;
    }
  }
  for (double& width : widths) width *= length / sum;
  return widths;
}

std::vector<double> axis(const std::vector<Plane>& planes, const Layers& layers) {
  std::vector<double> coordinates{planes.front().coordinate};
  for (std::size_t k = 1; k < planes.size(); ++k) {
    for (const double width : widths(planes[k - 1], planes[k], layers))
      coordinates.push_back(coordinates.back() + width);
    coordinates.back() = planes[k].coordinate;
  }
  return coordinates;
}

bool is_in_body(double x, double y, double z) {
  const bool in_lower_box =
      Body::front < x && x < Body::rear && Body::floor < z && z < Body::bonnet;
  const bool in_cabin =
      Body::windscreen < x && x < Body::rear_window && Body::bonnet < z && z < Body::roof;
  return y < Body::half_width && (in_lower_box || in_cabin);
}

/// A stand-in for the mesh of the flow around one half of a car of the thesis, Section 5.3.4, whose
/// body and blocks are not published: a grid around a body of two boxes above the road, cut off at
/// the plane of symmetry y = 0, with thin layers at the planes of the body's faces and the road.
/// Its numbers of nodes and of cells are within 2 % of the 1,710,978 and 1,610,234 of the thesis;
/// its least quality is .0043 as there, its mean .621 (thesis: .6195). Unlike there, all nodes
/// inside but those at the body's edges and corners are regular. edge_scale (1 to 8): all lengths
/// of cells times that. As many thin layers remain, so cells get fewer by less than its third
/// power, and flatter. Throws InputError for another edge scale.
AnyMesh generate(const DomainParameters& p) {
  require_edge_scale("car", p.edge_scale, 8);
  Layers layers;
  layers.thinnest *= p.edge_scale;
  layers.widest *= p.edge_scale;
  const std::array axes{axis({{inlet, false},
                              {Body::front, true},
                              {Body::windscreen, true},
                              {Body::rear_window, true},
                              {Body::rear, true},
                              {outlet, false}},
                             layers),
                        axis({{0.0, false}, {Body::half_width, true}, {side, false}}, layers),
                        axis({{0.0, true},
                              {Body::floor, true},
                              {Body::bonnet, true},
                              {Body::roof, true},
                              {sky, false}},
                             layers)};
  const auto middle = [&](std::size_t direction, std::size_t i) {
    return 0.5 * (axes[direction][i] + axes[direction][i + 1]);
  };
  return mesh_of(tensor_grid(axes,
                             [&](std::size_t i, std::size_t j, std::size_t k) {
                               return !is_in_body(middle(0, i), middle(1, j), middle(2, k));
                             }),
                 "generated flow mesh");
}

const RegisteredDomain registered({.name = "car",
                                   .description = "stand-in for Section 5.3.4's mesh: its size and "
                                                  "quality, a grid around a body of two boxes",
                                   .dimension = 3,
                                   .elements = {"hexahedra"},
                                   .make = generate});

}  // namespace
}  // namespace smoothfem
