// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "meshes/tools/gmsh_planar.h"

namespace smoothfem {

/// Splits the longest inner edges of a mesh of triangles at their midpoints, no two of one triangle
/// in a round. Stops at n_cells triangles, or at one less, as every split adds two.
void refine_to(PlanarCells& mesh, std::size_t n_cells);

/// Flips n_flips inner edges, chosen at random, to the other diagonal of their two triangles. The
/// two triangles form a strictly convex quadrilateral, inner nodes keep 3 to 9 edges, and no edge
/// between two boundary nodes appears or disappears. Valid meshes stay valid. Returns the number of
/// flips done: less than n_flips if a long search finds no further one.
std::size_t flip_edges(PlanarCells& mesh, std::size_t n_flips, std::uint64_t seed);

}  // namespace smoothfem
