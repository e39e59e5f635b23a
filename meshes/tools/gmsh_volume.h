// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "meshes/tools/mesh_cells.h"
#include "meshes/tools/outline.h"

namespace smoothfem {

/// A round cylinder whose axis is parallel to z.
struct Cylinder {
  Point<2> centre;
  double radius, bottom, top;
};

/// How long the edges shall be, in units of the coordinates.
struct EdgeLengths {
  double boundary;  ///< on curves and surfaces
  double inside;    ///< between cells' nodes inside the solid
};

/// Adds the union of some cylinders without others to Gmsh's model.
void add_solid(const std::vector<Cylinder>& joined, const std::vector<Cylinder>& removed);

/// Meshes the union of some cylinders without others with tetrahedra by Gmsh (Delaunay, one
/// thread). Curves are divided into equal edges, circles into a multiple of four of them from the
/// positive x direction on, so the extremes in x and y are nodes; boundary nodes lie on the
/// cylinders and planes. Throws InputError with Gmsh's words if it cannot.
VolumeCells mesh_solid(const std::vector<Cylinder>& joined, const std::vector<Cylinder>& removed,
                       const EdgeLengths& lengths);

/// The same for the region between polygons, swept along z from 0 to a length.
VolumeCells mesh_extrusion(const Polygons& polygons, double length, const EdgeLengths& lengths);

}  // namespace smoothfem
