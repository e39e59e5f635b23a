#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// The subdivision mesh of the thesis, Section 5.3.2, before its distortion: a cube with edges 2000
/// and its centre at the origin, refined towards the centre. An octant is cut into eight cubes; the
/// templates of hexahedron_templates.h refine the one at the centre in all directions and its
/// neighbours as far as they touch it. The two thirds of that cube next to the centre are the next
/// level's octant. Ten levels give the 6,165 nodes and 5,984 hexahedra of the thesis;
/// edge_scale (1 to 10) times fewer levels make a smaller mesh. Throws InputError for another edge
/// scale.
VolumeMesh generate_subdivided_cube(double edge_scale = 1.0);

}  // namespace smoothfem
