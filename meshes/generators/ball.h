#pragma once

#include <cstdint>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A ball of 258 surface nodes, those of an octahedron divided three times, and 346 nodes of a
/// randomly disturbed grid inside, with their Delaunay tetrahedra (thesis, Section 5.2.1). Flat
/// tetrahedra make its quality low. Surface nodes are fixed. Throws InputError if the edge scale is
/// not 1.
VolumeMesh generate_ball(double edge_scale, std::uint64_t seed);

}  // namespace smoothfem
