#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A stand-in for the pavilion roof of the thesis, Section 5.1.2, whose mesh is not published: a
/// tensile membrane between six anchors with sagging edge cables, drawn up to the rings of two
/// masts. Lengths in metres. It has the 23,101 nodes and 22,676 quadrilaterals of the thesis and
/// its qualities q*_min = .2467 (at the corners) and q_mean = .9814 to .0005: an unstructured mesh
/// of the plan, whose cells the membrane's slope makes longer. The anchors stay, other nodes of
/// cables and rings move along them; there are no other features. edge_scale (1 to 3, beyond which
/// rings have corners): edges longer by this factor. Throws InputError for another one.
SurfaceMesh generate_roof(double edge_scale = 1.0);

}  // namespace smoothfem
