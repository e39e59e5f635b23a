// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/quality/mean_ratio.h"

#include "smoothing/quality/target_corners.h"

namespace smoothfem {

namespace {

template <int dim, int spacedim>
double mean_ratio_of(const Mesh<dim, spacedim>& mesh, CellIndex cell) {
  double q;
  const Point<spacedim>* const x = mesh.coordinates().data();
  with_target_corners(mesh, cell, coordinates_at(x),
                      [&](auto corners) { q = target_mean_ratio(mesh, cell, corners); });
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
