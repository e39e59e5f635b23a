// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

#include "smoothing/mesh/volume_elements.h"

/// Node orders of files that differ from those of volume_elements.h. Tetrahedra, pyramids and
/// hexahedra have one order everywhere; of the formats known here only VTK's wedge differs:
///
///         5                4
///        /|\              /|\       Inside, in Gmsh, Medit and Abaqus (left) the nodes 0, 1, 2 run
///       3---4            3---5      counterclockwise seen from 3, 4, 5. VTK_WEDGE (right) wants
///       | | |            | | |      the normal of 0, 1, 2 to point outwards, away from 3, 4, 5:
///       | 2 |            | 1 |      clockwise seen from there.
///       |/ \|            |/ \|
///       0---1            0---2
///
/// VTK's voxels and pixels list their nodes row by row.
///
///        6-------7
///       /|      /|          2---3
///      4-------5 |          |   |
///      | |     | |          0---1
///      | 2-----|-3
///      |/      |/
///      0-------1

namespace smoothfem {

/// Maps positions in a VTK row to nodes of volume_elements.h, and back: each map is its own
/// inverse.
inline constexpr std::array<LocalIndex, 6> vtk_wedge{0, 2, 1, 3, 5, 4};
inline constexpr std::array<LocalIndex, 4> vtk_pixel{0, 1, 3, 2};
inline constexpr std::array<LocalIndex, 8> vtk_voxel{0, 1, 3, 2, 4, 5, 7, 6};

/// Reorders a row that has as many indices as the order.
template <class Row, std::size_t n>
void permute(Row&& row, const std::array<LocalIndex, n>& order) {
  std::array<typename std::remove_reference_t<Row>::value_type, n> copy;
  std::copy_n(row.begin(), n, copy.begin());
  for (std::size_t k = 0; k < n; ++k) row[k] = copy[order[k]];
}

}  // namespace smoothfem
