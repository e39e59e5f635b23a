#include "smoothing/quality/mean_ratio.h"

#include "smoothing/mesh/cell_blocks.h"

namespace smoothfem {

double cell_mean_ratio(const PlanarMesh& mesh, CellIndex cell) {
  double q;
  with_corners(mesh.topology().cell_nodes(cell), mesh.coordinates(),
               [&](auto corners) SMOOTHFEM_INLINE_LAMBDA { q = mean_ratio(corners); });
  return q;
}

}  // namespace smoothfem
