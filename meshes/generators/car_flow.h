#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A stand-in for the mesh of the flow around one half of a car of the thesis, Section 5.3.4, whose
/// body and blocks are not published: a grid around a body of two boxes above the road, cut off at
/// the plane of symmetry y = 0, with thin layers at the planes of the body's faces and the road.
/// Its numbers of nodes and of cells are within 2 % of the 1,710,978 and 1,610,234 of the thesis;
/// its least quality is .0043 as there, its mean .621 (thesis: .6195). Unlike there, all nodes
/// inside but those at the body's edges and corners are regular. edge_scale (1 to 8): all lengths
/// of cells times that. As many thin layers remain, so cells get fewer by less than its third
/// power, and flatter. Throws InputError for another edge scale.
VolumeMesh generate_car_flow(double edge_scale = 1.0);

}  // namespace smoothfem
