// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Returns the coordinates of a mesh file that an external program has made from `mesh`, in the
/// order of its nodes. Nodes are matched by the numbers in the file if it has some, otherwise by
/// their order. Fixed nodes keep their coordinates exactly, even if the file has few digits. In
/// meshes of second order these are all but free_nodes_of_second_order(). Throws SmootherFailure if
/// the file cannot be read, has other nodes or cells, has moved fixed nodes, or has curved cells
/// that are not proven valid (jacobian_bounds.h).
template <int dim>
std::vector<Point<dim>> returned_coordinates(const std::filesystem::path& file,
                                             const Mesh<dim>& mesh);

}  // namespace smoothfem
