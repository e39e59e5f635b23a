#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A stand-in for the tensile structure of the thesis, Section 5.1.2, whose mesh is not published:
/// a membrane between four anchors and edge cables that sag, drawn up to two frames. It has the
/// 23,101 nodes and 22,676 quadrilaterals of the thesis, and its qualities q*_min = .2467 and
/// q_mean = .9814 to .001: squares in plan, longer the steeper the membrane is. The anchors and the
/// corners of the frames stay; other nodes of edges and frames move along them. edge_scale (1 to 4,
/// beyond which cells at the frames would make features): edges longer by this factor. Throws
/// InputError for another one.
SurfaceMesh generate_roof(double edge_scale = 1.0);

}  // namespace smoothfem
