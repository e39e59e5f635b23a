// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "meshes/tools/mesh_cells.h"

namespace smoothfem {

/// Makes hexahedra between the planes x, y and z through given coordinates, at least two in each
/// direction, ascending; x runs fastest. keep(i, j, k): true if the cell that starts at the i-th,
/// j-th and k-th plane is kept; default: all. Nodes of no cell are left out.
VolumeCells tensor_grid(
    const std::array<std::vector<double>, 3>& planes,
    const std::function<bool(std::size_t, std::size_t, std::size_t)>& keep = {});

}  // namespace smoothfem
