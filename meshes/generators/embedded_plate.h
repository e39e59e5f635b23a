#pragma once

#include <cstdint>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A plate with two holes, of hexahedra, in a cuboid of tetrahedra, with a layer of pyramids
/// between both: about 5,748 hexahedra, 2,220 pyramids and 26,082 tetrahedra (thesis,
/// Section 5.4.1). Only the nodes on the cuboid's sides are fixed. Throws InputError if the edge
/// scale is not 1.
VolumeMesh generate_embedded_plate(double edge_scale);

}  // namespace smoothfem
