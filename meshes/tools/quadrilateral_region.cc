// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/quadrilateral_region.h"

#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "meshes/tools/edge_length_search.h"
#include "meshes/tools/quad_split.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/optimization/untangle.h"

namespace smoothfem {

namespace {

/// Takes every stride-th corner: Gmsh meshes these, and halving all edges restores the others.
Polygons every_nth(const Polygons& polygons, std::size_t stride) {
  Polygons coarse;
  for (const auto& polygon : polygons) {
    coarse.emplace_back();
    for (std::size_t i = 0; i < polygon.size(); i += stride) coarse.back().push_back(polygon[i]);
  }
  return coarse;
}

/// Finds the corner in the middle of those left out between the ends of a coarse boundary edge.
class SkippedCorners {
 public:
  explicit SkippedCorners(const Polygons& polygons) : polygons_(polygons) {
    for (std::size_t p = 0; p < polygons.size(); ++p)
      for (std::size_t i = 0; i < polygons[p].size(); ++i)
        corners_[{polygons[p][i].x(), polygons[p][i].y()}] = {p, i};
  }

  Point<2> between(const Point<2>& a, const Point<2>& b, std::size_t stride) const {
    const auto [polygon, i] = corners_.at({a.x(), a.y()});
    const auto& corners = polygons_[polygon];
    const bool forwards = (i + stride) % corners.size() == corners_.at({b.x(), b.y()}).second;
    return corners[(i + (forwards ? stride / 2 : corners.size() - stride / 2)) % corners.size()];
  }

 private:
  const Polygons& polygons_;
  /// By coordinates: number of the polygon, and of the corner in it.
  std::map<std::pair<double, double>, std::pair<std::size_t, std::size_t>> corners_;
};

PlanarCells coarse_mesh(const Polygons& polygons, double edge_length, std::size_t stride,
                        PlanarPattern pattern, const RegionMeshing& meshing = {}) {
  return mesh_region(every_nth(polygons, stride), static_cast<double>(stride) * edge_length,
                     pattern, meshing);
}

/// Halves the mesh until all corners are in. Arcs reach into the cells at their chords: such cells
/// are made valid, and smoothed before they are halved again.
PlanarCells halved(PlanarCells mesh, const Polygons& polygons, std::size_t stride) {
  const SkippedCorners skipped(polygons);
  for (; stride > 1; stride /= 2) {
    mesh = split_to_quadrilaterals(mesh, [&](NodeIndex a, NodeIndex b) {
      return skipped.between(mesh.coordinates[a], mesh.coordinates[b], stride);
    });
    auto topology =
        std::make_shared<const Topology>(2, mesh.coordinates.size(), std::move(mesh.cells));
    PlanarMesh moved(std::move(topology), std::move(mesh.coordinates));
    untangle(moved);
    mesh = cells_of(moved);
    if (stride > 2) smooth_quadrilaterals(mesh);
  }
  return mesh;
}

}  // namespace

void smooth_quadrilaterals(PlanarCells& cells) {
  PlanarMesh mesh = mesh_of(std::move(cells), "generated region");
  auto method = make_method<2>("getme");
  smooth(mesh, method);
  cells = cells_of(mesh);
}

PlanarCells mesh_quadrilaterals(const Polygons& polygons, double edge_length,
                                const RegionMeshing& meshing) {
  return halved(coarse_mesh(polygons, edge_length, 2, PlanarPattern::quadrilaterals, meshing),
                polygons, 2);
}

PlanarCells mesh_with_n_quadrilaterals(const Polygons& polygons, std::size_t n_cells,
                                       const QuadrilateralMeshing& meshing) {
  constexpr int max_tries = 24;
  constexpr double few = 0.03, fixable = 0.25;  // fractions of the cells
  const std::size_t stride = std::size_t{1} << meshing.n_halvings;
  const std::size_t n_cells_halved_once = n_cells / (stride * stride / 4);
  const auto wanted = static_cast<double>(n_cells_halved_once);
  EdgeLengthSearch search(std::sqrt(area(polygons) / static_cast<double>(n_cells)),
                          (1.0 - 0.5 * few) * wanted);
  struct {
    double deviation;
    PlanarCells mesh;
  } below{fixable, {}}, above{std::numeric_limits<double>::infinity(), {}};
  for (int i = 0; i < max_tries && below.deviation > few; ++i) {
    PlanarCells coarse = coarse_mesh(polygons, search.length(), stride, meshing.pattern);
    cut_invalid_quadrilaterals(coarse);
    // Halving makes as many cells of each as it has corners.
    const auto n = static_cast<double>(coarse.cells.n_entries());
    search.found(n);
    auto& side = n <= wanted ? below : above;
    if (std::abs(n / wanted - 1.0) >= side.deviation) continue;
    side = {std::abs(n / wanted - 1.0), std::move(coarse)};
  }
  PlanarCells best = std::move(below.mesh.cells.empty() ? above.mesh : below.mesh);
  // A quadrilateral gives four cells, its two triangles six.
  if (best.cells.n_entries() < n_cells_halved_once)
    cut_worst_quadrilaterals(best, (n_cells_halved_once - best.cells.n_entries()) / 2);
  return halved(std::move(best), polygons, stride);
}

PlanarCells mesh_with_n_quadrilaterals(const std::vector<Outline>& outlines, std::size_t n_cells,
                                       std::size_t n_boundary_edges, double edge_scale,
                                       const QuadrilateralMeshing& meshing) {
  const std::size_t stride = std::size_t{1} << meshing.n_halvings;
  const auto n_coarse = static_cast<std::size_t>(
      std::lround(static_cast<double>(n_boundary_edges / stride) / edge_scale));
  const auto n = std::lround(static_cast<double>(n_cells) / (edge_scale * edge_scale));
  return mesh_with_n_quadrilaterals(divide(outlines, stride * n_coarse, stride),
                                    static_cast<std::size_t>(n), meshing);
}

}  // namespace smoothfem
