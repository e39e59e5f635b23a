// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "meshes/tools/gmsh_tetrahedra.h"
#include "meshes/tools/mesh_cells.h"
#include "meshes/tools/outline.h"

namespace smoothfem {

/// A round cylinder whose axis is parallel to z.
struct Cylinder {
  Point<2> centre;
  double radius, bottom, top;
};

/// Target edge lengths, in units of the coordinates.
struct EdgeLengths {
  double boundary;  ///< on curves and surfaces
  double inside;    ///< between cells' nodes inside the solid
};

/// Adds the union of some cylinders minus others to Gmsh's model.
void add_solid(const std::vector<Cylinder>& joined, const std::vector<Cylinder>& removed);

/// Meshes the union of some cylinders minus others with tetrahedra by Gmsh (Delaunay, one thread).
/// Curves are divided into equal edges. Circles start in the positive x direction and have a
/// multiple of four edges, so that the extremes in x and y are nodes. Boundary nodes lie on the
/// cylinders and planes. Throws InputError with Gmsh's message if it fails.
VolumeCells mesh_solid(const std::vector<Cylinder>& joined, const std::vector<Cylinder>& removed,
                       const EdgeLengths& lengths);

/// Meshes the ball of radius 1 about the origin in the same way.
VolumeCells mesh_ball(const EdgeLengths& lengths);

/// Meshes the region between polygons, swept along z from 0 to a length, in the same way.
VolumeCells mesh_extrusion(const Polygons& polygons, double length, const EdgeLengths& lengths,
                           TetrahedronAlgorithm algorithm = TetrahedronAlgorithm::delaunay);

}  // namespace smoothfem
