#include "meshes/generators/gear.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "meshes/generators/edge_length_search.h"
#include "meshes/generators/gear_outline.h"
#include "meshes/generators/gmsh_planar.h"
#include "meshes/generators/quadrilateral_region.h"
#include "meshes/generators/triangulation_edits.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

/// Meshes with varying edge length until the count of cells is met. Triangles may be too few by a
/// little, because edges can be split afterwards.
PlanarCells with_n_cells(const Polygons& polygons, const GearParameters& p) {
  constexpr int most_tries = 16;
  const bool tri = p.element_type == ElementType::triangle;
  const auto target = static_cast<double>(p.n_cells);
  const double aim = tri ? 0.998 * target : target;
  const double close_enough = tri ? 0.002 : 0.001;
  EdgeLengthSearch search(std::sqrt(area(polygons) / target * (tri ? 4.0 / std::sqrt(3.0) : 1.0)),
                          aim);
  PlanarCells best;
  double best_deviation = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_tries && best_deviation > close_enough * target; ++i) {
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

}  // namespace

GearParameters gear_of_the_thesis(ElementType type, double edge_scale) {
  require_edge_scale("gear", edge_scale, 10);
  GearParameters p;
  p.element_type = type;
  p.n_boundary_edges =
      2 * static_cast<std::size_t>(static_cast<double>(p.n_boundary_edges / 2) / edge_scale);
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
  const Polygons polygons = divide(gear_outlines(p), p.n_boundary_edges, tri ? 1 : 2);
  PlanarCells cells = with_n_cells(polygons, p);
  if (tri) {
    refine_to(cells, p.n_cells);
    const auto n_flips = p.edge_flips_per_cell * static_cast<double>(cells.cells.size());
    flip_edges(cells, static_cast<std::size_t>(n_flips), p.seed);
  }
  return mesh_of(std::move(cells), "generated gear");
}

}  // namespace smoothfem
