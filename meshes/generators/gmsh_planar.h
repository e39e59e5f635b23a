#pragma once

#include <vector>

#include "meshes/generators/mesh_cells.h"

namespace smoothfem {

/// Meshes the region inside the first polygon and outside the others with Gmsh. The polygons'
/// corners are the first nodes, in their order, and their edges the only boundary edges.
/// edge_length: size of the inner cells. recombine: pair triangles to quadrilaterals; some
/// triangles remain. Throws InputError with Gmsh's words if it cannot.
PlanarCells mesh_region(const std::vector<std::vector<Point<2>>>& polygons, double edge_length,
                        bool recombine);

}  // namespace smoothfem
