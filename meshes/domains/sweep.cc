// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "meshes/domains/catalogue.h"
#include "meshes/tools/quadrilateral_region.h"
#include "meshes/tools/sweep.h"

namespace smoothfem {
namespace {

/// Returns hub, web and rim; x is the distance from the axis. Counterclockwise from the hub's bore.
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

/// A stand-in for the sweep mesh of the thesis, Section 5.3.3, before its distortion. The profile
/// of a wheel, meshed with 817 quadrilaterals, is turned about the axis y by a quarter in 15
/// layers. Its 14,352 nodes and 12,255 hexahedra are those of the thesis, whose profile is not
/// published. edge_scale (1 to 3): longer edges give fewer quadrilaterals and layers. Throws
/// InputError for another edge scale.
AnyMesh generate(const DomainParameters& p) {
  require_edge_scale("sweep mesh", p.edge_scale, 3);
  // Number of boundary edges of 817 cells with 897 nodes (Euler).
  constexpr std::size_t n_boundary_edges = 158, n_cells = 817;
  constexpr double n_layers = 15.0;
  const PlanarCells base =
      mesh_with_n_quadrilaterals({profile()}, n_cells, n_boundary_edges, p.edge_scale);
  // With layers of this thickness smoothing ends at about the mean ratio of the thesis, .72.
  constexpr double angle = 70.0 / 180.0 * std::numbers::pi;
  VolumeCells cells = sweep(base, equal_layers(angle, n_layers / p.edge_scale));
  for (Point<3>& point : cells.coordinates)
    point = {point.x() * std::cos(point.z()), point.y(), point.x() * std::sin(point.z())};
  return mesh_of(std::move(cells), "generated sweep mesh");
}

const RegisteredDomain registered({.name = "sweep",
                                   .description = "stand-in for Section 5.3.3's mesh: its counts, "
                                                  "the profile of a wheel turned in 15 layers",
                                   .dimension = 3,
                                   .elements = {"hexahedra"},
                                   .make = generate});

}  // namespace
}  // namespace smoothfem
