// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "meshes/tools/mesh_cells.h"

namespace smoothfem {

/// A connected closed surface of triangles.
struct ClosedSurface {
  std::vector<Point<3>> points;
  CompressedRows<NodeIndex> triangles;
};

/// Fills the surface with tetrahedra by Netgen; edges grow from the surface's to edge_length. The
/// result's first nodes are the surface's points. Throws InputError if Netgen is missing or fails.
VolumeCells fill_by_netgen(const ClosedSurface& surface, double edge_length);

}  // namespace smoothfem
