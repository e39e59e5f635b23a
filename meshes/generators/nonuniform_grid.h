#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// The nonuniform grid of the thesis, Section 5.3.1: 13 x 4 x 11 nodes, equidistant in y, in x and
/// z finer towards the middle. The thesis does not print its coordinates; here intervals of x and z
/// grow by constant factors from the middle to both sides, x and z lie between 0 and 1, and the
/// factors and the step of y give the printed mean ratios: least .0010, greatest .5714, mean .0943.
/// edge_scale (1 to 5): that much fewer intervals in x and z. Throws InputError for another one.
VolumeMesh generate_nonuniform_grid(double edge_scale = 1.0);

}  // namespace smoothfem
