// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/grid/tria.h>

#include <vector>

#include "smoothing/mesh/mesh.h"

// Includes deal.II's headers: for sources of this library only.

namespace smoothfem {

/// Makes a triangulation with the mesh's nodes, and its cells in the mesh's order; planar cells may
/// be rotated. materials: the material id of each cell; empty: 0.
template <int dim>
void fill_triangulation(const Mesh<dim>& mesh, const std::vector<unsigned int>& materials,
                        dealii::Triangulation<dim>& triangulation);

}  // namespace smoothfem
