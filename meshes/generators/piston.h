#pragma once

#include <cstdint>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A piston: a cylinder with grooves, a bowl, a hollow below and a hole for the pin, meshed with
/// tetrahedra of equal size; edge scale 1: about 4,129,608 tetrahedra (thesis, Section 5.5.2);
/// to 12. Boundary nodes are fixed. Throws InputError for an edge scale out of range.
VolumeMesh generate_piston(double edge_scale);

}  // namespace smoothfem
