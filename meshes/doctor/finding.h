// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "smoothing/mesh/point.h"

namespace smoothfem {

/// What may be wrong with a mesh.
enum class FindingKind {
  reversed_cells,    ///< the direction of the nodes is their only fault
  folded_cells,      ///< invalid in spite of a right direction
  bent_cells,        ///< have valid corners, but midside nodes make them invalid
  straight_sides,    ///< of linear cells, where a neighbour of second order bends
  collapsed_cells,   ///< name a node twice
  doubled_cells,     ///< have the nodes of another cell
  crowded_facets,    ///< belong to three or more cells
  one_sided,         ///< a surface without upper side
  hanging_nodes,     ///< lie inside a side or face of another cell
  coincident_nodes,  ///< lie where another node lies
  touching_nodes,    ///< nothing but the node joins the pieces around it
  touching_edges,    ///< nothing but the edge joins the pieces around it
  unused_nodes,      ///< belong to no cell
};

/// Returns the name of a kind in JSON, for example "hanging-nodes".
const char* name_of(FindingKind kind);

/// One fault of a mesh, in all places.
struct Finding {
  FindingKind kind;
  std::size_t count = 0;
  Point<3> at = Point<3>::Zero();   ///< first place
  std::optional<std::size_t> cell;  ///< first cell, as the file numbers it, otherwise from 0
  std::optional<std::size_t> node;  ///< first node
  std::string sentence;             ///< count, kind, first place, remedy
  bool is_repairable = false;       ///< by repair()
};

/// Returns "(x, y)", or "(x, y, z)" in space.
std::string place_text(const Point<3>& at, bool planar);

/// Returns for example "1 cell" or "3 cells".
std::string count_of(std::size_t n, const std::string& what);

}  // namespace smoothfem
