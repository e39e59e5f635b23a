// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Smallest and largest of some angles, in degrees.
struct AngleRange {
  double min = 0.0, max = 0.0;
};

/// Returns the interior angles at the corners of each cell, in [0, 360): above 180 at reentrant
/// corners. Angles of surface meshes are seen along the mean normal of their cell.
std::vector<AngleRange> cell_angle_ranges(const PlanarMesh& mesh);
std::vector<AngleRange> cell_angle_ranges(const SurfaceMesh& mesh);

/// Returns the dihedral angles at the edges of each cell, inside the cell between its two faces, in
/// [0, 360]. The normal of a quadrilateral face is that of its area vector, half the cross product
/// of its diagonals. An angle at a face without area counts as 180.
std::vector<AngleRange> cell_angle_ranges(const VolumeMesh& mesh);

/// Returns the range of these angles over all cells of a planar or volume mesh.
template <int dim>
AngleRange angle_range(const Mesh<dim>& mesh);

}  // namespace smoothfem
