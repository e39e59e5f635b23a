// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/constraints/node_ties.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Ties each hanging node to the corners of the edge or face in which it lies: its value is that of
/// a linear function on the edge or triangle, of a bilinear one on the quadrilateral.
template <int dim>
NodeTies hanging_ties(const Mesh<dim>& mesh);

}  // namespace smoothfem
