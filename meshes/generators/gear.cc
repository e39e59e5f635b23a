#include "meshes/generators/gear.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "meshes/generators/gear_outline.h"
#include "meshes/generators/gmsh_planar.h"
#include "meshes/generators/quad_split.h"
#include "meshes/generators/triangulation_edits.h"
#include "smoothing/mesh/input_error.h"

namespace smoothfem {

namespace {

using Polygons = std::vector<std::vector<Point<2>>>;

double area(const Polygons& polygons) {
  double total = 0.0;
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    double twice = 0.0;
    for (std::size_t i = 0; i < polygons[p].size(); ++i) {
      const auto &a = polygons[p][i], &b = polygons[p][(i + 1) % polygons[p].size()];
      twice += a.x() * b.y() - a.y() * b.x();
    }
    total += (p == 0 ? 0.5 : -0.5) * twice;
  }
  return total;
}

/// Every second corner: Gmsh meshes these, and halving all edges puts the others back.
Polygons every_second(const Polygons& polygons) {
  Polygons coarse;
  for (const auto& polygon : polygons) {
    coarse.emplace_back();
    for (std::size_t i = 0; i < polygon.size(); i += 2) coarse.back().push_back(polygon[i]);
  }
  return coarse;
}

/// Boundary midpoints of the coarse mesh, whose first nodes are the coarse polygons' corners.
std::map<std::pair<NodeIndex, NodeIndex>, Point<2>> skipped_corners(const Polygons& polygons) {
  std::map<std::pair<NodeIndex, NodeIndex>, Point<2>> middle;
  NodeIndex first = 0;
  for (const auto& polygon : polygons) {
    const auto n = static_cast<NodeIndex>(polygon.size() / 2);
    for (NodeIndex i = 0; i < n; ++i)
      middle[std::minmax(first + i, first + (i + 1) % n)] = polygon[2 * i + 1];
    first += n;
  }
  return middle;
}

PlanarCells triangles(const Polygons& polygons, double edge_length) {
  return mesh_region(polygons, edge_length, false);
}

PlanarCells quadrilaterals(const Polygons& polygons, double edge_length) {
  const auto middle = skipped_corners(polygons);
  return split_to_quadrilaterals(
      mesh_region(every_second(polygons), 2.0 * edge_length, true),
      [&](NodeIndex a, NodeIndex b) { return middle.at(std::minmax(a, b)); });
}

/// Search for the edge length that gives a count of cells. The count falls with the length, by no
/// known law near the boundary, and scatters.
class EdgeLengthSearch {
 public:
  EdgeLengthSearch(double first, double aim) : length_(first), aim_(aim) {}

  double length() const { return length_; }

  void found(double n_cells) {
    Try& side = n_cells > aim_ ? finer_ : coarser_;
    side = {true, std::log(length_), std::log(n_cells / aim_)};
    if (!finer_.known || !coarser_.known) {
      length_ *= n_cells / aim_;
      return;
    }
    // Between the two by a straight line in logarithms, but away from its ends.
    const double share = finer_.excess / (finer_.excess - coarser_.excess);
    length_ =
        std::exp(std::lerp(finer_.log_length, coarser_.log_length, std::clamp(share, 0.1, 0.9)));
  }

 private:
  struct Try {
    bool known = false;
    double log_length = 0.0, excess = 0.0;
  };

  double length_, aim_;
  Try finer_, coarser_;
};

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
    PlanarCells mesh =
        tri ? triangles(polygons, search.length()) : quadrilaterals(polygons, search.length());
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
