// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Smallest and largest of some angles, in degrees.
struct AngleRange {
  double min = 0.0, max = 0.0;
};

/// Interior angles at all corners of all cells, in [0, 360): more than 180 where a cell is not
/// convex.
AngleRange angle_range(const PlanarMesh& mesh);

/// Dihedral angles at all edges of all cells, inside the cell between its two faces there, in [0,
/// 360]. A quadrilateral face stands with the normal of its area vector, half the cross product of
/// its diagonals. An angle at a face of no area counts as 180.
AngleRange angle_range(const VolumeMesh& mesh);

}  // namespace smoothfem
