// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/domains/gear.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/edge_length_search.h"
#include "meshes/tools/gmsh_planar.h"
#include "meshes/tools/quadrilateral_region.h"
#include "meshes/tools/triangulation_edits.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

// --- The outlines --------------------------------------------------------------------------------

double angle_of(const Point<2>& vector) {
  return std::atan2(vector.y(), vector.x());
}

double involute_function(double angle) {
  return std::tan(angle) - angle;
}

/// Involute of the circle with radius `base` about the origin, between the base circle and `tip`.
/// It leaves the base circle at `start`. It turns to smaller angles if `side` is +1, to larger ones
/// if it is -1. Its arc length is base roll^2 / 2, which gives the constant speed.
Curve involute(double base, double tip, double start, double side, bool outwards) {
  const double last_roll = std::sqrt(tip * tip / (base * base) - 1.0);
  return {0.5 * base * last_roll * last_roll, [=](double t) -> Point<2> {
            const double roll = last_roll * std::sqrt(outwards ? t : 1.0 - t);
            return on_circle(Point<2>::Zero(), base * std::sqrt(1.0 + roll * roll),
                             start - side * (roll - std::atan(roll)));
          }};
}

void require(bool condition, const std::string& what) {
  if (!condition) throw InputError("the gear cannot be built: " + what);
}

Outline teeth(const GearParameters& p) {
  const double pi = std::numbers::pi, pressure = p.pressure_angle_degrees * pi / 180.0;
  const double pitch_radius = 0.5 * p.module * p.n_teeth;
  const double base_radius = pitch_radius * std::cos(pressure);
  require(p.root_radius < base_radius && base_radius < p.tip_radius,
          "the base circle of the involute, radius " + std::to_string(base_radius) +
              ", must lie between root and tip radius");
  // Half the tooth's angle at the pitch circle is a quarter of the pitch.
  const double half_at_base = 0.5 * pi / p.n_teeth + involute_function(pressure);
  const double half_at_tip =
      half_at_base - involute_function(std::acos(base_radius / p.tip_radius));
  require(half_at_tip > 0.0 && half_at_base < pi / p.n_teeth,
          "the teeth are pointed or touch at their roots; change tip radius or pressure angle");
  const Point<2> origin = Point<2>::Zero();
  Outline outline;
  for (int tooth = 0; tooth < p.n_teeth; ++tooth) {
    const double middle = 2.0 * pi * tooth / p.n_teeth, next = 2.0 * pi * (tooth + 1) / p.n_teeth;
    const double right = middle - half_at_base, left = middle + half_at_base;
    // Below the base circle there is no involute; the flank continues straight to the centre.
    outline.push_back(
        segment(on_circle(origin, p.root_radius, right), on_circle(origin, base_radius, right)));
    outline.push_back(involute(base_radius, p.tip_radius, right, -1.0, true));
    outline.push_back(arc(origin, p.tip_radius, middle - half_at_tip, middle + half_at_tip));
    outline.push_back(involute(base_radius, p.tip_radius, left, 1.0, false));
    outline.push_back(
        segment(on_circle(origin, base_radius, left), on_circle(origin, p.root_radius, left)));
    outline.push_back(arc(origin, p.root_radius, left, next - half_at_base));
  }
  return outline;
}

/// Turns an outline by 90 degrees `quarters` times; exact.
Outline turned(const Outline& outline, int quarters) {
  Outline result;
  for (const Curve& curve : outline)
    result.push_back({curve.length, [=, point = curve.point](double t) {
                        Point<2> p = point(t);
                        for (int i = 0; i < quarters; ++i) p = Point<2>(-p.y(), p.x());
                        return p;
                      }});
  return result;
}

/// The kidney in the first quadrant, symmetric about the diagonal.
Outline kidney(const GearParameters& p) {
  const double pi = std::numbers::pi, fillet = p.kidney_fillet_radius;
  const double offset = p.kidney_side + fillet;  // distance of the fillets' centres from the axis
  const double to_inner = p.kidney_inner_radius + fillet;
  const double to_outer = p.kidney_outer_radius - fillet;
  const double shift = p.kidney_outer_centre - offset;
  require(fillet > 0.0 && to_inner > offset && to_outer > std::abs(shift),
          "the kidneys' fillets do not fit between sides and arcs");
  // Fillets at the upper side: each touches the side and, from in- or outside, one of the arcs.
  const Point<2> inner(offset, std::sqrt(to_inner * to_inner - offset * offset));
  const Point<2> outer(offset,
                       p.kidney_outer_centre + std::sqrt(to_outer * to_outer - shift * shift));
  const Point<2> middle(p.kidney_outer_centre, p.kidney_outer_centre);
  require(inner.y() < outer.y(), "the kidneys' fillets overlap; make their radius smaller");
  const auto mirrored = [](const Point<2>& x) { return Point<2>(x.y(), x.x()); };
  const double inner_angle = angle_of(inner), outer_angle = angle_of(outer - middle);
  require(inner_angle > 0.25 * pi && outer_angle > 0.25 * pi, "the kidneys' sides overlap");
  const Point<2> low_start(p.kidney_side, inner.y()), low_end(p.kidney_side, outer.y());
  return {
      arc(middle, p.kidney_outer_radius, 0.5 * pi - outer_angle, outer_angle),
      arc(outer, fillet, outer_angle, pi),
      segment(low_end, low_start),
      arc(inner, fillet, pi, pi + inner_angle),
      arc(Point<2>::Zero(), p.kidney_inner_radius, inner_angle, 0.5 * pi - inner_angle),
      arc(mirrored(inner), fillet, 1.5 * pi - inner_angle, 1.5 * pi),
      segment(mirrored(low_start), mirrored(low_end)),
      arc(mirrored(outer), fillet, -0.5 * pi, 0.5 * pi - outer_angle),
  };
}

Outline bore(const GearParameters& p) {
  const double w = p.bore_half_width, a = p.arm_half_width_at_bore, e = p.arm_half_width_at_end;
  require(0.0 < e && 0.0 < a && a < w && w < p.arm_length,
          "the bore's arms must be narrower than its square and reach beyond it");
  const std::vector<Point<2>> quarter = {{w, -w},           {w, -a}, {p.arm_length, -e},
                                         {p.arm_length, e}, {w, a},  {w, w}};
  Outline side;
  for (std::size_t i = 0; i + 1 < quarter.size(); ++i)
    side.push_back(segment(quarter[i], quarter[i + 1]));
  Outline outline;
  for (int quarters = 0; quarters < 4; ++quarters)
    for (auto& curve : turned(side, quarters)) outline.push_back(std::move(curve));
  return outline;
}

}  // namespace

std::vector<Outline> gear_outlines(const GearParameters& p) {
  require(p.n_teeth >= 3, "it needs at least 3 teeth, not " + std::to_string(p.n_teeth));
  require(p.module > 0.0 && p.pressure_angle_degrees > 0.0 && p.pressure_angle_degrees < 45.0,
          "module and pressure angle must be positive, the angle below 45 degrees");
  require(
      std::numbers::sqrt2 * p.kidney_outer_centre + p.kidney_outer_radius < p.root_radius &&
          std::max(std::numbers::sqrt2 * p.bore_half_width, p.arm_length) < p.kidney_inner_radius,
      "bore, kidneys and root circle overlap");
  std::vector<Outline> outlines = {teeth(p)};
  for (int quarters = 0; quarters < 4; ++quarters) outlines.push_back(turned(kidney(p), quarters));
  outlines.push_back(bore(p));
  return outlines;
}

// --- The mesh ------------------------------------------------------------------------------------

namespace {

/// Varies the edge length until the number of cells is met. Triangles may be slightly too few,
/// because edges can be split afterwards.
PlanarCells with_n_cells(const Polygons& polygons, const GearParameters& p) {
  constexpr int max_tries = 16;
  const bool tri = p.element_type == ElementType::triangle;
  const auto target = static_cast<double>(p.n_cells);
  const double aim = tri ? 0.998 * target : target;
  const double close_enough = tri ? 0.002 : 0.001;
  EdgeLengthSearch search(std::sqrt(area(polygons) / target * (tri ? 4.0 / std::sqrt(3.0) : 1.0)),
                          aim);
  PlanarCells best;
  double best_deviation = std::numeric_limits<double>::infinity();
  for (int i = 0; i < max_tries && best_deviation > close_enough * target; ++i) {
    PlanarCells mesh = tri ? mesh_region(polygons, search.length(), PlanarPattern::triangles)
                           : mesh_quadrilaterals(polygons, search.length());
    const auto n = static_cast<double>(mesh.cells.size());
    search.found(n);
    if (std::abs(n - aim) >= best_deviation) continue;
    best_deviation = std::abs(n - aim);
    best = std::move(mesh);
  }
  const auto n = static_cast<double>(best.cells.size());
  if (std::abs(n - target) > 0.05 * target)
    throw InputError("the gear cannot be meshed with " + std::to_string(p.n_cells) + " cells and " +
                     std::to_string(p.n_boundary_edges) +
                     " boundary edges; the nearest count found is " +
                     std::to_string(best.cells.size()));
  return best;
}

/// at: see divide().
Polygons boundary_polygons(const GearParameters& p, double at = 0.0) {
  return divide(gear_outlines(p), p.n_boundary_edges,
                p.element_type == ElementType::triangle ? 1 : 2, at);
}

}  // namespace

GearParameters gear_of_the_thesis(ElementType type, double edge_scale) {
  require_edge_scale("gear", edge_scale, 10);
  GearParameters p;
  p.element_type = type;
  const std::size_t n_pairs = p.n_boundary_edges / 2;
  p.n_boundary_edges = 2 * static_cast<std::size_t>(static_cast<double>(n_pairs) / edge_scale);
  const double n_cells = type == ElementType::quadrilateral ? 6229.0 : 14346.0;
  p.n_cells = static_cast<std::size_t>(n_cells / (edge_scale * edge_scale));
  return p;
}

PlanarMesh generate_gear(const GearParameters& p) {
  if (p.element_type == ElementType::polygon)
    throw InputError("the gear can be meshed with triangles or quadrilaterals only");
  if (p.n_cells < 1) throw InputError("the gear needs at least one cell");
  if (!(p.edge_flips_per_cell >= 0.0))
    throw InputError("the gear's edge flips per cell must not be negative");
  const bool tri = p.element_type == ElementType::triangle;
  PlanarCells cells = with_n_cells(boundary_polygons(p), p);
  if (tri) {
    refine_to(cells, p.n_cells);
    const auto n_flips = p.edge_flips_per_cell * static_cast<double>(cells.cells.size());
    flip_edges(cells, static_cast<std::size_t>(n_flips), p.seed);
  }
  return mesh_of(std::move(cells), "generated gear");
}

namespace {

GearParameters gear_of(const DomainParameters& p) {
  const bool tri = p.elements == "triangles";
  GearParameters gear =
      gear_of_the_thesis(tri ? ElementType::triangle : ElementType::quadrilateral, p.edge_scale);
  gear.seed = p.seed;
  return gear;
}

AnyMesh generate(const DomainParameters& p) {
  return generate_gear(gear_of(p));
}

AnyOntoBoundary boundary(const DomainParameters& p) {
  const GearParameters gear = gear_of(p);
  return boundary_through(boundary_polygons(gear), boundary_polygons(gear, 0.5));
}

const RegisteredDomain registered(
    {.name = "gear",
     .description = "involute gear with 17 teeth and five holes, like that of Chapter 6",
     .dimension = 2,
     .elements = {"triangles", "quadrilaterals"},
     .random_elements = {"triangles"},
     .make = generate,
     .boundary = boundary});

}  // namespace
}  // namespace smoothfem
