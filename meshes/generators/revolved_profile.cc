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
  return closed({{bore, half_hub},
                 {bore, -half_hub},
                 {hub, -half_hub},
                 {hub, -half_web},
                 {rim, -half_web},
                 {rim, -half_rim},
                 {tyre, -half_rim},
                 {tyre, half_rim},
                 {rim, half_rim},
                 {rim, half_web},
                 {hub, half_web},
                 {hub, half_hub}});
}

}  // namespace

VolumeMesh generate_revolved_profile(double edge_scale) {
  require_edge_scale("sweep mesh", edge_scale, 3);
  // As many edges on the boundary as 817 cells with 897 nodes have (Euler).
  constexpr std::size_t n_boundary_edges = 158, n_cells = 817;
  constexpr double n_layers = 15.0;
  const PlanarCells base =
      mesh_with_n_quadrilaterals({profile()}, n_cells, n_boundary_edges, edge_scale);
  // Layers so thick that smoothing ends at about the mean ratio of the thesis, .72.
  constexpr double angle = 70.0 / 180.0 * std::numbers::pi;
  VolumeCells cells = sweep(base, equal_layers(angle, n_layers / edge_scale));
  for (Point<3>& p : cells.coordinates)
    p = {p.x() * std::cos(p.z()), p.y(), p.x() * std::sin(p.z())};
  return mesh_of(std::move(cells), "generated sweep mesh");
}

}  // namespace smoothfem
