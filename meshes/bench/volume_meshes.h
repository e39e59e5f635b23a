// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "smoothing/mesh/mesh.h"

namespace smoothfem::bench {

/// Makes a gear of 6,235 quadrilaterals swept in eleven layers: about 68,600 hexahedra. distorted:
/// to a mean quality of about 0.46, as in the thesis' Section 6.3.
VolumeMesh swept_gear(bool distorted);

/// Makes a cube with a bore by Gmsh: about 568,000 tetrahedra, 100,000 nodes. distorted: to a mean
/// quality of about 0.42. Takes half a minute; cached in the folder for temporary files.
VolumeMesh bored_cube(bool distorted);

/// Makes a cube of n^3 smaller ones of six tetrahedra each.
VolumeMesh kuhn_cube(std::uint32_t n);

}  // namespace smoothfem::bench
