// SPDX-License-Identifier: GPL-3.0-or-later
// Solids of several kinds, each with about 100,000 nodes at edge scale 1: planar shapes that are
// swept along a straight line, an arc or a screw. Swept along a straight line, the solid is meshed
// as it is; otherwise its mesh is that of the straight one, bent.
#include <cmath>
#include <functional>
#include <numbers>

#include "meshes/domains/shapes.h"
#include "meshes/tools/gmsh_volume.h"
#include "meshes/tools/quadrilateral_region.h"
#include "meshes/tools/sweep.h"

namespace smoothfem {
namespace {

constexpr double pi = std::numbers::pi;

struct Solid {
  Shape section;
  double length;  ///< of the sweep
  /// Takes a point of the section at a height z from 0 to length to its place.
  std::function<Point<3>(const Point<3>&)> bend = [](const Point<3>& p) { return p; };
};

/// Sweeps the section by an angle around an axis parallel to y, whose distance from the origin is
/// the radius.
Solid turned(const Shape& section, double radius, double angle) {
  return {section, radius * angle, [=](const Point<3>& p) -> Point<3> {
            const double at = p.z() / radius, r = radius + p.x();
            return {r * std::cos(at), p.y(), r * std::sin(at)};
          }};
}

/// Turns the section about its origin while it rises, and shrinks it to a fraction.
Solid twisted(const Shape& section, double length, double angle, double fraction) {
  return {section, length, [=](const Point<3>& p) -> Point<3> {
            const double t = p.z() / length, scale = 1.0 + t * (fraction - 1.0);
            const Point<2> turned =
                scale * Point<2>(std::cos(angle * t) * p.x() - std::sin(angle * t) * p.y(),
                                 std::sin(angle * t) * p.x() + std::cos(angle * t) * p.y());
            return {turned.x(), turned.y(), p.z()};
          }};
}

Solid plate() {
  return {bracket_shape(), 0.8};
}
Solid heat_sink() {
  return {comb_shape(0.35), 1.5};
}
Solid sheet() {
  return {channel_shape(0.8), 3.0};
}
Solid elbow() {
  return turned(washer_shape(), 3.0, 0.5 * pi);
}
Solid hook() {
  return turned({{{circle(Point<2>::Zero(), 0.5)}}}, 1.5, 4.0 / 3.0 * pi);
}
Solid drill() {
  return twisted(star_shape(), 3.0, 0.5 * pi, 1.0);
}
Solid blade() {
  return twisted({{{airfoil(0.3)}}}, 2.0, pi / 6.0, 0.6);
}

AnyMesh generate(const std::string& name, const Solid& solid, const DomainParameters& p) {
  constexpr int largest_edge_scale = 8;
  constexpr double n_nodes = 1e5;
  require_edge_scale(name, p.edge_scale, largest_edge_scale);
  const bool hexahedra = p.elements == "hexahedra";
  const double of_cell = hexahedra ? 1.0 : std::sqrt(2.0);  // cubic edges over volume, a node
  const double volume = solid.length * area(solid.section.polygons(0.01, 1));
  const double edge_length = p.edge_scale * std::cbrt(of_cell * volume / n_nodes);
  const auto algorithm = p.algorithm == "hxt"      ? TetrahedronAlgorithm::hxt
                         : p.algorithm == "netgen" ? TetrahedronAlgorithm::netgen
                                                   : TetrahedronAlgorithm::delaunay;
  // Tetrahedra fill a solid with fewer inner nodes if its boundary's edges are as short as theirs.
  const EdgeLengths lengths{1.25 * edge_length, 0.8 * edge_length};
  VolumeCells cells =
      hexahedra ? sweep(mesh_quadrilaterals(solid.section.polygons(edge_length, 2), edge_length),
                        equal_layers(solid.length, solid.length / edge_length))
                : mesh_extrusion(solid.section.polygons(lengths.boundary, 1), solid.length, lengths,
                                 algorithm);
  for (Point<3>& point : cells.coordinates) point = solid.bend(point);
  return mesh_of(std::move(cells), "generated " + name);
}

RegisteredDomain solid(const std::string& name, const std::string& description, Solid (*form)()) {
  return registered_form({.name = name,
                          .description = description,
                          .dimension = 3,
                          .elements = {"tetrahedra", "hexahedra"},
                          .algorithms = {{"tetrahedra", {"delaunay", "hxt", "netgen"}}},
                          .make = {}},
                         form, generate);
}

const RegisteredDomain registered[] = {
    solid("bracket-plate", "plate of the bracket's shape, with holes", plate),
    solid("heat-sink", "six fins on a base, swept", heat_sink),
    solid("sheet", "corrugated sheet", sheet),
    solid("elbow", "pipe bent by 90 degrees", elbow),
    solid("hook", "rod bent by 240 degrees", hook),
    solid("drill", "the star, twisted by 90 degrees", drill),
    solid("blade", "the section of a wing, twisted by 30 degrees and tapered", blade)};

}  // namespace
}  // namespace smoothfem
