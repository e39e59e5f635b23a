#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A ring-shaped hole in a cuboid of 24 x 25 x 16 unit hexahedra (thesis, Section 5.4.2): the
/// hexahedra within three layers around the ring make room for tetrahedra, with one layer of
/// pyramids between both. The ring is a torus of 5,226 triangles. Boundary nodes, those of the ring
/// among them, are fixed. Throws InputError if the edge scale is not 1.
VolumeMesh generate_embedded_ring(double edge_scale);

}  // namespace smoothfem
