#pragma once

#include <cstdint>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A vessel with an arch and two branches, filled with tetrahedra and wrapped in six layers of thin
/// prisms: about 35,551 tetrahedra and 80,724 prisms (thesis, Section 5.4.3). Boundary nodes are
/// fixed. Throws InputError if the edge scale is not 1.
VolumeMesh generate_vessel(double edge_scale);

}  // namespace smoothfem
