// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "meshes/tools/gmsh_tetrahedra.h"
#include "meshes/tools/mesh_cells.h"

namespace smoothfem {

/// Adds a pyramid on each of some quadrilaterals, on the side to which their normals point. The
/// apex is `height` times the mean edge length above the centre. Returns the pyramids' triangles,
/// directed to the outside of the pyramids.
CompressedRows<NodeIndex> append_pyramids(VolumeCells& mesh, const CompressedRows<NodeIndex>& bases,
                                          double height);

/// Fills the space between closed surfaces of triangles between nodes of the mesh, the first around
/// the others, with tetrahedra; see fill_with_tetrahedra.
void append_tetrahedra(VolumeCells& mesh, const std::vector<CompressedRows<NodeIndex>>& surfaces,
                       double edge_length, const std::string& name,
                       double optimization_threshold = usual_optimization_threshold);

}  // namespace smoothfem
