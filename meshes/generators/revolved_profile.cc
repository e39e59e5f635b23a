#include "meshes/generators/revolved_profile.h"

#include <cmath>
#include <numbers>

#include "meshes/generators/quadrilateral_region.h"
#include "meshes/generators/sweep.h"

namespace smoothfem {

namespace {

/// Hub, web and rim; x is the distance from the axis. Counterclockwise from the hub's bore.
Outline profile() {
  constexpr double bore = 0.5, hub = 2.0, rim = 4.0, tyre = 5.2;
  constexpr double half_hub = 1.5, half_web = 0.9, half_rim = 2.0;
  const std::vector<Point<2>> corners = {{bore, half_hub},  {bore, -half_hub}, {hub, -half_hub},
                                         {hub, -half_web},  {rim, -half_web},  {rim, -half_rim},
                                         {tyre, -half_rim}, {tyre, half_rim},  {rim, half_rim},
                                         {rim, half_web},   {hub, half_web},   {hub, half_hub}};
  Outline outline;
  for (std::size_t i = 0; i < corners.size(); ++i)
    outline.push_back(segment(corners[i], corners[(i + 1) % corners.size()]));
  return outline;
}

}  // namespace

VolumeMesh generate_revolved_profile(double edge_scale) {
  require_edge_scale("sweep mesh", edge_scale, 3);
  // As many edges on the boundary as 817 cells with 897 nodes have (Euler).
  constexpr double n_boundary_edges = 158.0, n_cells = 817.0, n_layers = 15.0;
  const auto n_pairs = static_cast<std::size_t>(std::lround(0.5 * n_boundary_edges / edge_scale));
  const PlanarCells base = mesh_with_n_quadrilaterals(
      divide({profile()}, 2 * n_pairs, 2),
      static_cast<std::size_t>(std::lround(n_cells / (edge_scale * edge_scale))));
  const auto layers = static_cast<int>(std::lround(n_layers / edge_scale));
  // Layers so thick that smoothing ends at about the mean ratio of the thesis, .72.
  constexpr double angle = 70.0 / 180.0 * std::numbers::pi;
  std::vector<double> angles;
  for (int i = 0; i <= layers; ++i) angles.push_back(angle * i / layers);
  VolumeCells cells = sweep(base, angles);
  for (Point<3>& p : cells.coordinates)
    p = {p.x() * std::cos(p.z()), p.y(), p.x() * std::sin(p.z())};
  return mesh_of(std::move(cells), "generated sweep mesh");
}

}  // namespace smoothfem
