// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "smoothing/mesh/mesh_labels.h"

namespace smoothfem {

/// Returns the plane that all points lie in, up to 1e-9 of their extent; nothing if there is none.
/// A plane along two coordinate axes has these as its axes, so that its points keep their
/// coordinates: x and y, x and z, or y and z.
std::optional<PlaneInSpace> plane_of(const std::vector<Point<3>>& points);

}  // namespace smoothfem
