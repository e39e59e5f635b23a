// SPDX-License-Identifier: GPL-3.0-or-later
// Planar regions of several kinds, each with about 100,000 nodes at edge scale 1.
#include "meshes/domains/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshes/tools/quadrilateral_region.h"

namespace smoothfem {

namespace {

constexpr double pi = std::numbers::pi;

/// Returns a closed curve through positions at parameters from 0 to 1.
template <class PointAt>
Outline closed_curve(const PointAt& point_at, std::size_t n_points) {
  std::vector<Point<2>> points;
  for (std::size_t i = 0; i <= n_points; ++i)
    points.push_back(point_at(static_cast<double>(i % n_points) / static_cast<double>(n_points)));
  return {polyline(std::move(points))};
}

}  // namespace

Polygons Shape::polygons(double edge_length, std::size_t multiple_of, double at) const {
  Polygons all;
  for (const auto& [curves, factor] : outlines) {
    double length = 0.0;
    for (const Curve& curve : curves) length += curve.length;
    const double n = length / (factor * edge_length * static_cast<double>(multiple_of));
    const std::size_t n_portions = std::max<std::size_t>(
        {curves.size(), static_cast<std::size_t>(std::lround(n)), std::size_t{4} / multiple_of});
    all.push_back(divide({curves}, multiple_of * n_portions, multiple_of, at).front());
  }
  return all;
}

bool Shape::is_graded() const {
  return std::any_of(outlines.begin(), outlines.end(),
                     [](const ShapeOutline& outline) { return outline.edge_factor != 1.0; });
}

Shape washer_shape() {
  return {{{circle(Point<2>::Zero(), 1.0)}, {circle(Point<2>::Zero(), 0.6)}}};
}

Shape comb_shape(double fin) {
  constexpr int n_fins = 6;
  constexpr double base = 0.4, gap = 0.35, top = 1.6;
  const double width = n_fins * fin + (n_fins - 1) * gap;
  std::vector<Point<2>> corners{{0.0, 0.0}, {width, 0.0}};
  for (int k = n_fins - 1; k >= 0; --k) {
    const double left = k * (fin + gap), right = left + fin;
    if (k < n_fins - 1) corners.emplace_back(right, base);
    corners.emplace_back(right, top);
    corners.emplace_back(left, top);
    if (k > 0) corners.emplace_back(left, base);
  }
  return {{{closed(corners)}}};
}

Shape bracket_shape() {
  constexpr double arm = 1.2, fillet = 0.5;
  const Point<2> centre(arm + fillet, arm + fillet);
  const Outline outer{segment({0, 0}, {4, 0}),
                      segment({4, 0}, {4, arm}),
                      segment({4, arm}, {arm + fillet, arm}),
                      arc(centre, fillet, -0.5 * pi, -pi),
                      segment({arm, arm + fillet}, {arm, 3}),
                      segment({arm, 3}, {0, 3}),
                      segment({0, 3}, {0, 0})};
  constexpr double half = 0.15;
  const Outline slot{
      segment({1.6, 0.6 - half}, {2.6, 0.6 - half}), arc({2.6, 0.6}, half, -0.5 * pi, 0.5 * pi),
      segment({2.6, 0.6 + half}, {1.6, 0.6 + half}), arc({1.6, 0.6}, half, 0.5 * pi, 1.5 * pi)};
  return {{{outer},
           {circle({0.6, 0.6}, 0.35)},
           {circle({0.6, 2.4}, 0.3)},
           {circle({3.4, 0.6}, 0.25)},
           {slot}}};
}

Shape channel_shape(double width) {
  constexpr double length = 8.0, wave = 0.2;
  const double half = 0.5 * width;
  constexpr std::size_t n_points = 400;
  std::vector<Point<2>> below, above;
  for (std::size_t i = 0; i <= n_points; ++i) {
    const double x = length * static_cast<double>(i) / n_points;
    below.emplace_back(x, wave * std::sin(pi * x) - half);
    above.emplace_back(length - x, wave * std::sin(pi * (length - x)) + half);
  }
  return {{{{polyline(below), segment(below.back(), above.front()), polyline(above),
             segment(above.back(), below.front())}}}};
}

Shape star_shape() {
  constexpr int n_points = 5;
  std::vector<Point<2>> corners;
  for (int k = 0; k < 2 * n_points; ++k)
    corners.push_back(on_circle(Point<2>::Zero(), k % 2 == 0 ? 1.0 : 0.45, pi * k / n_points));
  return {{{closed(corners)}}};
}

Outline airfoil(double thickness) {
  constexpr std::size_t n_points = 400;
  // The last coefficient closes the trailing edge.
  const auto half_thickness = [&](double x) {
    return 5.0 * thickness *
           (0.2969 * std::sqrt(x) + x * (-0.1260 + x * (-0.3516 + x * (0.2843 - 0.1036 * x))));
  };
  std::vector<Point<2>> above, below;  // points are dense at the nose
  for (std::size_t i = 0; i <= n_points; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(n_points);
    const double x = s * s, back = (1.0 - s) * (1.0 - s);
    above.emplace_back(back, i == n_points ? 0.0 : half_thickness(back));
    below.emplace_back(x, i == n_points ? 0.0 : -half_thickness(x));
  }
  above.front() = below.back() = {1.0, 0.0};
  return {polyline(above), polyline(below)};
}

namespace {

Shape disc() {
  return {{{circle(Point<2>::Zero(), 1.0)}}};
}

/// Edges at the hole are a sixth of the others.
Shape holed_plate() {
  return {
      {{closed({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})}, {circle(Point<2>::Zero(), 0.1), 1.0 / 6.0}}};
}

/// Edges at the wing are a sixth of the others.
Shape wing_tunnel() {
  return {{{closed({{-1, -1}, {2, -1}, {2, 1}, {-1, 1}})}, {airfoil(0.12), 1.0 / 6.0}}};
}

Shape comb() {
  return comb_shape(0.15);
}

Shape channel() {
  return channel_shape(0.4);
}

/// A disc without a thin sector: the re-entrant corner has 345 degrees.
Shape cracked_disc() {
  constexpr double half_gap = 7.5 / 180.0 * pi;
  const Point<2> origin = Point<2>::Zero();
  return {{{{segment(origin, on_circle(origin, 1.0, half_gap)),
             arc(origin, 1.0, half_gap, 2.0 * pi - half_gap),
             segment(on_circle(origin, 1.0, -half_gap), origin)}}}};
}

/// A smooth shore with two islands.
Shape lake() {
  constexpr std::size_t n_points = 720;
  const auto shore = [](double t) {
    const double a = 2.0 * pi * t;
    const double r =
        1.0 + 0.15 * std::cos(2.0 * a) + 0.12 * std::sin(3.0 * a) + 0.08 * std::cos(7.0 * a + 1.0);
    return on_circle(Point<2>::Zero(), r, a);
  };
  const auto island = [](double t) {
    const double a = 2.0 * pi * t;
    return on_circle({0.25, 0.2}, 0.16 + 0.04 * std::cos(3.0 * a), a);
  };
  return {{{closed_curve(shore, n_points)},
           {closed_curve(island, n_points)},
           {circle({-0.4, -0.25}, 0.1)}}};
}

bool has_quadrilaterals(const DomainParameters& p) {
  return p.elements == "quadrilaterals";
}

double edge_length_of(const Shape& shape, const DomainParameters& p) {
  constexpr double n_nodes = 1e5;
  const double of_cell =
      has_quadrilaterals(p) ? 1.0 : 2.0 / std::sqrt(3.0);  // area over edge^2, a node
  const double region = area(shape.polygons(0.01, 1));
  return p.edge_scale * std::sqrt(of_cell * region / n_nodes);
}

AnyOntoBoundary boundary(const Shape& shape, const DomainParameters& p) {
  const double edge_length = edge_length_of(shape, p);
  const std::size_t multiple = has_quadrilaterals(p) ? 2 : 1;
  return boundary_through(shape.polygons(edge_length, multiple),
                          shape.polygons(edge_length, multiple, 0.5));
}

AnyMesh generate(const std::string& name, const Shape& shape, const DomainParameters& p) {
  constexpr int largest_edge_scale = 16;
  require_edge_scale(name, p.edge_scale, largest_edge_scale);
  const double edge_length = edge_length_of(shape, p);
  RegionMeshing meshing{.is_graded = shape.is_graded()};
  if (p.algorithm == "delaunay") meshing.algorithm = TriangleAlgorithm::delaunay;
  if (p.algorithm == "meshadapt") meshing.algorithm = TriangleAlgorithm::mesh_adapt;
  return mesh_of(has_quadrilaterals(p)
                     ? mesh_quadrilaterals(shape.polygons(edge_length, 2), edge_length, meshing)
                     : mesh_region(shape.polygons(edge_length, 1), edge_length,
                                   PlanarPattern::triangles, meshing),
                 "generated " + name);
}

RegisteredDomain shape(const std::string& name, const std::string& description, Shape (*form)()) {
  return registered_form(
      {.name = name,
       .description = description,
       .dimension = 2,
       .elements = {"triangles", "quadrilaterals"},
       .algorithms = {{"triangles", {"frontal", "delaunay", "meshadapt"}}},
       .make = {},
       .boundary = [form](const DomainParameters& p) { return boundary(form(), p); }},
      form, generate);
}

const RegisteredDomain registered[] = {
    shape("disc", "disc of radius 1", disc),
    shape("washer", "disc with a round hole of 0.6 times its radius", washer_shape),
    shape("holed-plate", "square with a small hole; edges grow from the hole", holed_plate),
    shape("wing", "rectangle around the section of a wing; edges grow from it", wing_tunnel),
    shape("bracket", "L with a rounded inner corner, three holes and a slot", bracket_shape),
    shape("channel", "channel between two waves, 20 times as long as wide", channel),
    shape("crack", "disc without a sector of 15 degrees, a re-entrant corner of 345 degrees",
          cracked_disc),
    shape("star", "star with five points, acute and re-entrant corners", star_shape),
    shape("comb", "six thin fins on a base", comb),
    shape("lake", "smooth uneven shore with two islands", lake)};

}  // namespace
}  // namespace smoothfem
