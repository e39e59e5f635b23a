#include "smoothing/quality/mean_ratio.h"

#include "smoothing/mesh/cell_blocks.h"

namespace smoothfem {

namespace {

template <int dim>
double mean_ratio_of(const Mesh<dim>& mesh, CellIndex cell) {
  double q;
  with_corners<dim>(mesh.topology().cell_nodes(cell), mesh.coordinates(),
                    [&](auto corners) SMOOTHFEM_INLINE_LAMBDA { q = mean_ratio(corners); });
  return q;
}

}  // namespace

double cell_mean_ratio(const PlanarMesh& mesh, CellIndex cell) {
  return mean_ratio_of<2>(mesh, cell);
}
double cell_mean_ratio(const VolumeMesh& mesh, CellIndex cell) {
  return mean_ratio_of<3>(mesh, cell);
}

}  // namespace smoothfem
