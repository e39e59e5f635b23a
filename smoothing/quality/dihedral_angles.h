// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Smallest and largest of some angles, in degrees.
struct AngleRange {
  double min = 0.0, max = 0.0;
};

/// Interior angles at the corners of each cell, in [0, 360): more than 180 where it is not convex.
/// Those of surface meshes are seen along the mean normal of their cell.
std::vector<AngleRange> cell_angle_ranges(const PlanarMesh& mesh);
std::vector<AngleRange> cell_angle_ranges(const SurfaceMesh& mesh);

/// Dihedral angles at the edges of each cell, inside the cell between its two faces there, in [0,
/// 360]. A quadrilateral face stands with the normal of its area vector, half the cross product of
/// its diagonals. An angle at a face of no area counts as 180.
std::vector<AngleRange> cell_angle_ranges(const VolumeMesh& mesh);

/// The same angles of all cells of a planar or volume mesh.
template <int dim>
AngleRange angle_range(const Mesh<dim>& mesh);

}  // namespace smoothfem
