// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// True if the trilinear mapping of a hexahedron has a positive Jacobian determinant everywhere, as
/// finite elements need. Positive determinants at its corners (valid in the sense of Definition
/// 3.1) do not ensure that inside. The determinant is quadratic in each reference coordinate. It is
/// positive if its 27 Bernstein coefficients are (sufficient, and nearly necessary). corners: in
/// the order of volume_elements.h.
bool has_positive_mapping(const std::array<Point<3>, 8>& corners);

}  // namespace smoothfem
