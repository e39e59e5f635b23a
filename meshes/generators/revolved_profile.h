#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A stand-in for the sweep mesh of the thesis, Section 5.3.3, before its distortion: the profile
/// of a wheel, meshed with 817 quadrilaterals, is turned about the axis y by a quarter in 15
/// layers. Its 14,352 nodes and 12,255 hexahedra are those of the thesis, whose profile is not
/// published. edge_scale (1 to 3): longer edges give fewer quadrilaterals and layers. Throws
/// InputError for another one.
VolumeMesh generate_revolved_profile(double edge_scale = 1.0);

}  // namespace smoothfem
