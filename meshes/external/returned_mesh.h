// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// The coordinates of a mesh file that another program has made from `mesh`, in the order of its
/// nodes: by the numbers in the file where it has some, otherwise one after the other. Fixed nodes
/// keep theirs exactly, however few digits the file has. Throws SmootherFailure if the file cannot
/// be read, has other nodes or cells, or has moved fixed nodes.
template <int dim>
std::vector<Point<dim>> returned_coordinates(const std::filesystem::path& file,
                                             const Mesh<dim>& mesh);

}  // namespace smoothfem
