#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A stand-in for the pump carter of the thesis, Section 5.5.3, before its distortion: a plate with
/// round corners, two large bores and 16 small ones, meshed with quadrilaterals and swept along z.
/// 2.78 million nodes and 2.65 million hexahedra, within .5 % of the thesis, and as there 90 % of
/// the nodes have eight cells. edge_scale (1 to 8) gives edge_scale^3 times fewer cells. Takes two
/// seconds and half a gigabyte for 1. Throws InputError for another edge scale.
VolumeMesh generate_pump_housing(double edge_scale = 1.0);

}  // namespace smoothfem
