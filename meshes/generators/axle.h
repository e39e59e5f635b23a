#pragma once

#include <cstdint>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A stub axle of genus 17: a shaft and a flange with a bore along the axis and 16 holes, meshed
/// with tetrahedra that are small at the holes and large elsewhere (thesis, Section 5.2.3). Edge
/// scale 1: about 400,128 tetrahedra; to 6. Boundary nodes are fixed. Throws InputError for an edge
/// scale out of range.
VolumeMesh generate_axle(double edge_scale);

}  // namespace smoothfem
