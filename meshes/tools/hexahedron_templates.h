// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

namespace smoothfem {

/// A point of the lattice that divides the unit cube's edges into thirds: coordinates 0 to 3.
using LatticePoint = std::array<int, 3>;
/// Nodes of a hexahedron in the order of volume_elements.h.
using LatticeCell = std::array<LatticePoint, 8>;

/// Refinement templates of a hexahedron, the unit cube. They divide their edge, face or volume into
/// thirds and keep the faces that do not touch it (Schneiders, Refining quadrilateral and
/// hexahedral element meshes, 1996; templates T2, T4 and T8 of the thesis, Section 5.3.2). axis: 0,
/// 1 or 2 for x, y, z. Cells are valid.

/// Returns 5 hexahedra for the edge through the origin along an axis. Mean ratios .6357, .7048,
/// .8399.
std::vector<LatticeCell> edge_template(int axis);
/// Returns 13 hexahedra for the face through the origin normal to an axis. Mean ratios .5400 to 1.
std::vector<LatticeCell> face_template(int axis);
/// Returns 27 cubes.
std::vector<LatticeCell> volume_template();
/// Returns the cube itself.
std::vector<LatticeCell> whole_template();

}  // namespace smoothfem
