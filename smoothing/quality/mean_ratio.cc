// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/quality/mean_ratio.h"

#include "smoothing/simd/cells.h"

namespace smoothfem {

namespace {

template <int dim, int spacedim>
double mean_ratio_of(const Mesh<dim, spacedim>& mesh, CellIndex cell) {
  double q;
  with_corners<dim>(mesh.topology().cell_nodes(cell), mesh.coordinates().data(),
                    [&](auto corners) { q = mean_ratio(upper_side(mesh, cell), corners); });
  return q;
}

}  // namespace

double cell_mean_ratio(const PlanarMesh& mesh, CellIndex cell) {
  return mean_ratio_of(mesh, cell);
}
double cell_mean_ratio(const VolumeMesh& mesh, CellIndex cell) {
  return mean_ratio_of(mesh, cell);
}
double cell_mean_ratio(const SurfaceMesh& mesh, CellIndex cell) {
  return mean_ratio_of(mesh, cell);
}

}  // namespace smoothfem
