// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "meshes/tools/mesh_cells.h"

namespace smoothfem {

/// Returns the Delaunay tetrahedra of some nodes, by Gmsh, for which `keeps` accepts centroid and
/// mean ratio. name: for messages, for example "the ball". Throws InputError with Gmsh's message if
/// it fails.
VolumeCells delaunay_mesh(std::vector<Point<3>> nodes, const std::string& name,
                          const std::function<bool(const Point<3>& centre, double quality)>& keeps);

}  // namespace smoothfem
