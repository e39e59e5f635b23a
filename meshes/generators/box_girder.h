#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A stand-in for the part of a prestressed concrete bridge of the thesis, Section 5.1.3: a box
/// girder along z with a straight tendon duct at four places. type: hexahedron, 307,530 nodes and
/// 260,496 cells as in the thesis, the cross section swept in 134 layers; or tetrahedron, with
/// octagonal ducts, about 53,978 nodes and 262,201 cells (within 2 %), by Gmsh. edge_scale (1 to 2)
/// gives edge_scale^3 times fewer cells. Throws InputError for other types and scales.
VolumeMesh generate_box_girder(ElementType type, double edge_scale = 1.0);

}  // namespace smoothfem
