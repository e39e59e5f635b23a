// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "meshes/tools/mesh_cells.h"

namespace smoothfem {

/// The Delaunay tetrahedra of some nodes, by Gmsh, as far as `keeps` says so of their centroid and
/// mean ratio. name: "the ball". Throws InputError with Gmsh's words if it cannot.
VolumeCells delaunay_mesh(std::vector<Point<3>> nodes, const std::string& name,
                          const std::function<bool(const Point<3>& centre, double quality)>& keeps);

}  // namespace smoothfem
