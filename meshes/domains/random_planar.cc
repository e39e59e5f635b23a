// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshes/distortion/counter_random.h"
#include "meshes/domains/catalogue.h"
#include "meshes/tools/grid_region.h"
#include "meshes/tools/quad_split.h"
#include "meshes/tools/quadrilateral_region.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {
namespace {

/// Streams of random numbers of the same seed, by purpose.
enum Stream : std::uint64_t { disturbance, removal, cutting };

// --- The domain ----------------------------------------------------------------------------------

/// A circle whose radius varies by the fraction `wave`, in several waves around it.
Outline wavy_circle(const Point<2>& centre, double radius, double wave, double phase) {
  constexpr int n = 2000;
  std::vector<Point<2>> points;
  for (int i = 0; i <= n; ++i) {
    const double t = 2.0 * std::numbers::pi * (i % n) / n;
    const double r =
        1.0 + wave * (std::cos(3.0 * t + phase) + 0.7 * std::cos(5.0 * t + 2.0 * phase));
    points.push_back(on_circle(centre, r * radius, t));
  }
  return {polyline(std::move(points))};
}

std::vector<Outline> domain() {
  constexpr int n_holes = 8;  // around one in the middle
  std::vector<Outline> outlines{wavy_circle(Point<2>::Zero(), 10.0, 0.07, 1.0),
                                wavy_circle({0.3, -0.2}, 1.9, 0.12, 2.0)};
  for (int i = 0; i < n_holes; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / n_holes + 0.15 * std::sin(7.0 * i);
    const double distance = 5.9 + 0.5 * std::cos(5.0 * i), radius = 1.5 + 0.3 * std::sin(3.0 * i);
    outlines.push_back(wavy_circle(on_circle(Point<2>::Zero(), distance, angle), radius, 0.12, i));
  }
  return outlines;
}

// --- Triangles -----------------------------------------------------------------------------------

/// Returns the wanted numbers of squares and boundary edges exactly, from a finer grid without some
/// of its squares.
GridRegion region_with(const Polygons& polygons, std::size_t n_cells, std::size_t n_boundary_edges,
                       std::uint64_t seed) {
  constexpr int max_tries = 60;
  double spacing = std::sqrt(area(polygons) / static_cast<double>(n_cells));
  for (int i = 0; i < max_tries; ++i, spacing *= 0.998) {
    GridRegion region(polygons, spacing);
    if (region.n_boundary_edges() > n_boundary_edges) continue;
    const std::size_t n_dents = (n_boundary_edges - region.n_boundary_edges()) / 2;
    if (region.n_cells() < n_cells + n_dents) continue;
    const std::size_t n_corners = region.n_cells() - n_cells - n_dents;
    if (region.remove(n_dents, 3, counter_random(seed, removal, 0).next()) == n_dents &&
        region.remove(n_corners, 2, counter_random(seed, removal, 1).next()) == n_corners)
      return region;
  }
  throw InputError(
      "no grid has the squares that the random planar domain needs; choose another seed");
}

bool is_convex(const PlanarCells& squares, CellIndex c) {
  const auto row = squares.cells[c];
  const auto p = [&](std::size_t k) { return squares.coordinates[row[k % 4]]; };
  for (std::size_t k = 0; k < 4; ++k)
    if (!(cross(p(k + 1) - p(k), p(k + 3) - p(k)) > 0.0)) return false;
  return true;
}

/// Moves each node at random by up to a radius. If its squares would not stay convex, tries a half,
/// a quarter, ... of the movement.
PlanarCells disturbed(const Topology& topology, PlanarCells squares, double radius,
                      std::uint64_t seed) {
  for (NodeIndex i = 0; i < squares.coordinates.size(); ++i) {
    const Point<2> original = squares.coordinates[i];
    SplitMix64 random = counter_random(seed, disturbance, i);
    const double distance = radius * std::sqrt(random.uniform());
    Point<2> step =
        on_circle(Point<2>::Zero(), distance, 2.0 * std::numbers::pi * random.uniform());
    const auto cells = topology.node_cells(i);
    do {
      squares.coordinates[i] = original + step;
      step *= 0.5;
    } while (!std::all_of(cells.begin(), cells.end(),
                          [&](CellIndex c) { return is_convex(squares, c); }));
  }
  return squares;
}

/// Cuts each square at the diagonal whose triangles' circles do not contain the fourth node.
PlanarMesh with_delaunay_diagonals(PlanarCells squares) {
  std::vector<Diagonal> diagonals;
  for (CellIndex c = 0; c < squares.cells.size(); ++c) {
    const auto row = squares.cells[c];
    const auto p = [&](std::size_t k) { return squares.coordinates[row[k % 4]]; };
    const auto angle = [&](std::size_t k) {
      const Point<2> next = p(k + 1) - p(k), previous = p(k + 3) - p(k);
      return std::atan2(cross(next, previous), next.dot(previous));
    };
    // Joins the corners of the two opposite angles with the larger sum.
    diagonals.emplace_back(angle(1) + angle(3) <= angle(0) + angle(2) ? 0 : 1);
  }
  cut_quadrilaterals(squares, diagonals);
  return mesh_of(std::move(squares), "generated random planar mesh");
}

PlanarMesh triangles(double edge_scale, std::uint64_t seed) {
  constexpr double q_mean = 0.8193, n_squares = 1530.0;
  const Polygons polygons = divide(domain(), 4000, 1);
  const double spacing = edge_scale * std::sqrt(area(polygons) / n_squares);
  const PlanarCells squares = edge_scale == 1.0 ? region_with(polygons, 1530, 632, seed).cells()
                                                : GridRegion(polygons, spacing).cells();
  const Topology topology(2, squares.coordinates.size(), squares.cells);
  const auto with_radius = [&](double radius) {
    return with_delaunay_diagonals(disturbed(topology, squares, radius, seed));
  };
  double low = 0.0, high = spacing;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    (mesh_quality(with_radius(middle)).q_mean > q_mean ? low : high) = middle;
  }
  return with_radius(low);
}

// --- Quadrilaterals and mixed --------------------------------------------------------------------

PlanarCells quadrilaterals(std::size_t n_cells, std::size_t n_boundary_edges, double edge_scale) {
  PlanarCells cells = mesh_with_n_quadrilaterals(domain(), n_cells, n_boundary_edges, edge_scale);
  smooth_quadrilaterals(cells);
  return cells;
}

PlanarCells mixed(double edge_scale, std::uint64_t seed) {
  constexpr std::size_t n_whole = 3368, n_cut = 8732 / 2;
  PlanarCells cells = quadrilaterals(n_whole + n_cut, 852, edge_scale);
  std::vector<Diagonal> diagonals(cells.cells.size());
  std::size_t n = n_cut * diagonals.size() / (n_whole + n_cut);
  for (SplitMix64 random = counter_random(seed, cutting, 0); n > 0;) {
    Diagonal& diagonal = diagonals[random.below(diagonals.size())];
    if (diagonal) continue;
    diagonal = random.below(2);
    --n;
  }
  cut_quadrilaterals(cells, diagonals);
  return cells;
}

/// Stand-ins for the undistorted planar meshes of the thesis, Section 5.1.1, with its numbers of
/// nodes and cells (Table 5.1). The thesis' domain is not published; this one is round with waves
/// and has nine holes.
///
/// Triangles: the squares of a grid inside the domain, each cut at its Delaunay diagonal. Their
/// nodes are disturbed at random so that the mean quality is the printed one. Quadrilaterals:
/// Gmsh's, halved and smoothed. Mixed: such quadrilaterals, of which a random part is cut at one of
/// the diagonals. edge_scale: 1 to 2; the numbers of nodes and cells are met exactly for 1. Throws
/// InputError for another edge scale.
AnyMesh generate(const DomainParameters& p) {
  require_edge_scale("random planar domain", p.edge_scale, 2);
  if (p.elements == "triangles") return triangles(p.edge_scale, p.seed);
  return mesh_of(
      p.elements == "mixed" ? mixed(p.edge_scale, p.seed) : quadrilaterals(6111, 918, p.edge_scale),
      "generated random planar mesh");
}

const RegisteredDomain registered(
    {.name = "random-planar",
     .description =
         "stand-ins for Section 5.1.1's meshes: their counts, on a wavy disc with nine holes",
     .dimension = 2,
     .elements = {"triangles", "quadrilaterals", "mixed"},
     .random_elements = {"triangles", "mixed"},
     .make = generate});

}  // namespace
}  // namespace smoothfem
