#pragma once

#include <cstdint>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A hip stem: a tapered shaft with a neck and a ball on it, 1,228 boundary nodes as in the thesis
/// (Section 5.2.2, within 2 %), and 1,441 random nodes inside. Boundary nodes are fixed. Throws
/// InputError if the edge scale is not 1.
VolumeMesh generate_stem(double edge_scale, std::uint64_t seed);

}  // namespace smoothfem
