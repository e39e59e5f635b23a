#pragma once

#include <cstdint>
#include <string>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Stand-ins for the undistorted planar meshes of the thesis, Section 5.1.1, with its numbers of
/// nodes and cells (Table 5.1); its domain is not published, this one is round with waves and has
/// nine holes. elements:
/// - "triangles": the squares of a grid inside the domain, its nodes disturbed at random so that
/// the
///   mean quality is the printed one, each square cut at its Delaunay diagonal;
/// - "quadrilaterals": Gmsh's, halved and smoothed;
/// - "mixed": such quadrilaterals, some of them, chosen at random, cut at one of their diagonals.
/// edge_scale: 1 to 2; the numbers of nodes and cells are met exactly for 1. seed: of what is
/// random. Throws InputError for other elements and edge scales.
PlanarMesh generate_random_planar(const std::string& elements, double edge_scale = 1.0,
                                  std::uint64_t seed = 1);

}  // namespace smoothfem
