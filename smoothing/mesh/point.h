// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace smoothfem {

/// Coordinates of a point of the plane (spacedim = 2) or of space (3).
template <int spacedim>
using Point = Eigen::Matrix<double, spacedim, 1>;

/// Numbers of nodes and cells of a mesh, counted from 0.
using NodeIndex = std::uint32_t;
using CellIndex = std::uint32_t;

}  // namespace smoothfem
