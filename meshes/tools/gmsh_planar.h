// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "meshes/tools/mesh_cells.h"
#include "meshes/tools/outline.h"

namespace smoothfem {

/// Triangles, or triangles paired to quadrilaterals; some triangles remain. In rows: squares of a
/// grid except near the boundary, with fewer irregular nodes. (Gmsh's own packing of parallelograms
/// depends on memory addresses.)
enum class PlanarPattern { triangles, quadrilaterals, quadrilaterals_in_rows };

/// Gmsh's algorithms for triangles, by its numbers. Number 8 never ends on some domains.
enum class TriangleAlgorithm { mesh_adapt = 1, delaunay = 5, frontal = 6 };

struct RegionMeshing {
  TriangleAlgorithm algorithm = TriangleAlgorithm::frontal;
  bool is_graded = false;  ///< edges grow from the boundary's lengths to edge_length
};

/// Meshes the region inside the first polygon and outside the others with Gmsh. The polygons'
/// corners are the first nodes, in their order, and their edges the only boundary edges.
/// edge_length: size of the inner cells. Throws InputError with Gmsh's message if it fails.
PlanarCells mesh_region(const Polygons& polygons, double edge_length, PlanarPattern pattern,
                        const RegionMeshing& meshing = {});

}  // namespace smoothfem
