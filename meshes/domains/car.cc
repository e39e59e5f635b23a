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
/// Position of a wheel on the road; it ends at the floor and at the body's side.
struct Wheels {
  static constexpr double front_from = 0.45, front_to = 1.0, rear_from = 3.3, rear_to = 3.85;
  static constexpr double inside = 0.6;
};

/// Widths of cells: they start with a thin layer and grow by the factor `growth` up to the widest.
/// The four free parameters (cells are longer along the flow than across) give the thesis' number
/// of cells and its lowest and mean quality.
struct Layers {
  double widest, thinnest = 0.0014, growth = 2.7;
};
constexpr double widest_along = 0.107, widest_across = 0.0642;

/// A plane between pieces of an axis, and whether layers are thin there.
struct Plane {
  double coordinate;
  bool is_thin;
};

/// Returns the fewest layers that reach from one plane to the next, shrunk to fit.
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

/// True inside the body, in the grid before it takes the car's shape: two boxes on wheels.
bool is_in_body(double x, double y, double z) {
  if (y > Body::half_width) return false;
  const bool in_lower_box =
      Body::front < x && x < Body::rear && Body::floor < z && z < Body::bonnet;
  const bool in_cabin =
      Body::windscreen < x && x < Body::rear_window && Body::bonnet < z && z < Body::roof;
  const bool at_wheel = (Wheels::front_from < x && x < Wheels::front_to) ||
                        (Wheels::rear_from < x && x < Wheels::rear_to);
  return in_lower_box || in_cabin || (at_wheel && y > Wheels::inside && z < Body::floor);
}

/// Position where the grid's planes cross at the body, and the movement of that point to give the
/// car's shape. y: in the plane of symmetry and at the body's side.
struct Shift {
  double x, z;
  Point<3> in_middle, at_side;
};
const std::array shape{
    Shift{Body::front, Body::floor, {0.10, 0.0, 0.06}, {0.22, -0.10, 0.06}},
    Shift{Body::front, Body::bonnet, {0.04, 0.0, -0.20}, {0.20, -0.12, -0.22}},
    Shift{Body::windscreen, Body::bonnet, {-0.20, 0.0, 0.10}, {-0.05, -0.04, 0.06}},
    Shift{Body::windscreen, Body::roof, {0.55, 0.0, 0.04}, {0.62, -0.20, 0.0}},
    Shift{Body::rear_window, Body::bonnet, {0.35, 0.0, 0.12}, {0.30, -0.04, 0.10}},
    Shift{Body::rear_window, Body::roof, {-0.35, 0.0, 0.02}, {-0.40, -0.20, -0.02}},
    Shift{Body::rear, Body::bonnet, {0.0, 0.0, 0.15}, {-0.06, -0.08, 0.12}},
    Shift{Body::rear, Body::floor, {-0.05, 0.0, 0.10}, {-0.12, -0.08, 0.10}},
};

/// Position between neighbouring planes of an axis.
struct Place {
  std::size_t plane;
  double fraction;
};

template <std::size_t n>
Place place(const std::array<double, n>& planes, double coordinate) {
  std::size_t k = 0;
  while (k + 2 < n && coordinate > planes[k + 1]) ++k;
  return {k, (coordinate - planes[k]) / (planes[k + 1] - planes[k])};
}

/// Moves a point of the grid like the eight crossings of planes around it (trilinear). Points on
/// the road, in the sky, far ahead, behind and at the sides stay.
Point<3> shaped(const Point<3>& point) {
  constexpr std::array xs{inlet,      Body::front, Body::windscreen, Body::rear_window,
                          Body::rear, outlet};
  constexpr std::array ys{0.0, Body::half_width, side};
  constexpr std::array zs{0.0, Body::floor, Body::bonnet, Body::roof, sky};
  const std::array places{place(xs, point.x()), place(ys, point.y()), place(zs, point.z())};
  Point<3> moved = point;
  for (const Shift& shift : shape)
    for (std::size_t j = 0; j < 2; ++j) {
      const auto weight = [&](std::size_t direction, double plane_coordinate, const auto& planes) {
        const auto& [k, fraction] = places[direction];
        if (planes[k] == plane_coordinate) return 1.0 - fraction;
        return planes[k + 1] == plane_coordinate ? fraction : 0.0;
      };
      moved += weight(0, shift.x, xs) * weight(1, ys[j], ys) * weight(2, shift.z, zs) *
               (j == 0 ? shift.in_middle : shift.at_side);
    }
  return moved;
}

/// A stand-in for the mesh of the flow around one half of a car (thesis, Section 5.3.4), whose body
/// and blocks are not published. It is a grid around a body with bonnet, windscreen, roof, rear
/// window and the lower part of two wheels on the road. The plane of symmetry y = 0 cuts it off.
/// Thin layers follow the body's faces and the road. Faces between the grid's planes are ruled,
/// without arches or fillets.
///
/// Its numbers of nodes and cells are within 2 % of the 1,710,978 and 1,610,234 of the thesis, its
/// lowest and mean quality near the .0043 and .6195 there. Unlike there, all inner nodes but those
/// at the body's edges and corners are regular. edge_scale (1 to 8) multiplies all lengths of
/// cells. The number of thin layers stays the same, so that the number of cells falls by less than
/// its third power, and cells get flatter. Throws InputError for another edge scale.
AnyMesh generate(const DomainParameters& p) {
  require_edge_scale("car", p.edge_scale, 8);
  Layers along{.widest = widest_along * p.edge_scale};
  along.thinnest *= p.edge_scale;
  Layers across = along;
  across.widest = widest_across * p.edge_scale;
  const std::array axes{
      axis({{inlet, false},
            {Body::front, true},
            {Wheels::front_from, false},
            {Wheels::front_to, false},
            {Body::windscreen, true},
            {Body::rear_window, true},
            {Wheels::rear_to, false},
            {Body::rear, true},
            {outlet, false}},
           along),
      axis({{0.0, false}, {Wheels::inside, false}, {Body::half_width, true}, {side, false}},
           across),
      axis({{0.0, true},
            {Body::floor, true},
            {Body::bonnet, true},
            {Body::roof, true},
            {sky, false}},
           across)};
  const auto middle = [&](std::size_t direction, std::size_t i) {
    return 0.5 * (axes[direction][i] + axes[direction][i + 1]);
  };
  VolumeCells grid = tensor_grid(axes, [&](std::size_t i, std::size_t j, std::size_t k) {
    return !is_in_body(middle(0, i), middle(1, j), middle(2, k));
  });
  for (Point<3>& point : grid.coordinates) point = shaped(point);
  return mesh_of(std::move(grid), "generated flow mesh");
}

const RegisteredDomain registered({.name = "car",
                                   .description = "stand-in for Section 5.3.4's mesh: its size and "
                                                  "quality, a grid around a body on wheels",
                                   .dimension = 3,
                                   .elements = {"hexahedra"},
                                   .make = generate});

}  // namespace
}  // namespace smoothfem
