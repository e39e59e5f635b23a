// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "meshes/io/mesh_assembly.h"
#include "meshes/io/mesh_view.h"
#include "smoothing/tests/volume_meshes.h"

/// Meshes with faults, as a file has them.
namespace smoothfem::test {

inline const std::vector<Point<3>> unit_square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

inline MeshParts sick_parts(int dim, const std::vector<Point<3>>& x, const Cells& cells) {
  MeshParts parts;
  parts.coordinates = x;
  parts.elements[dim].nodes = rows_of(cells);
  return parts;
}

inline MeshParts sick_parts(const MeshView& mesh) {
  MeshParts parts;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) parts.coordinates.push_back(mesh.point(i));
  parts.elements[mesh.dimension()].nodes = mesh.topology().cells();
  return parts;
}

/// Lists the nodes of some cells in the opposite direction: as seen in a mirror.
inline void mirror(MeshParts& parts, const std::vector<CellIndex>& which) {
  ElementList& list = parts.elements[dimension_of(parts)];
  Cells cells;
  for (CellIndex c = 0; c < list.nodes.size(); ++c)
    cells.emplace_back(list.nodes[c].begin(), list.nodes[c].end());
  for (const CellIndex c : which) {
    auto& n = cells[c];
    if (dimension_of(parts) == 2)
      std::reverse(n.begin(), n.end());
    else if (n.size() == 4)
      std::swap(n[1], n[3]);
    else if (n.size() == 5)
      std::swap(n[1], n[3]);
    else
      std::rotate(n.begin(), n.begin() + static_cast<std::ptrdiff_t>(n.size() / 2), n.end());
  }
  list.nodes = rows_of(cells);
}

/// A square next to two smaller ones, or to three.
inline MeshParts quadtree(int n_small) {
  std::vector<Point<3>> x = unit_square;
  Cells cells{{0, 1, 2, 3}};
  for (int k = 0; k <= n_small; ++k) {
    const double y = k / static_cast<double>(n_small);
    if (k > 0 && k < n_small) x.emplace_back(1.0, y, 0.0);
    x.emplace_back(1.5, y, 0.0);
  }
  NodeIndex left = 1, right = 4;
  for (int k = 1; k <= n_small; ++k) {
    const NodeIndex upper_left = k == n_small ? 2 : right + 1;
    const NodeIndex upper_right = k == n_small ? right + 1 : right + 2;
    cells.push_back({left, right, upper_right, upper_left});
    left = upper_left;
    right = upper_right;
  }
  return sick_parts(2, x, cells);
}

/// A unit cube next to a layer of n x n small ones.
inline MeshParts octree(int n, BoxCells kind) {
  const VolumeMesh coarse = box_mesh(1, 1, 1, kind);
  const auto m = static_cast<std::uint32_t>(n);
  const VolumeMesh fine = box_mesh(m, m, 1, kind);
  MeshParts parts = sick_parts(coarse);
  Cells cells;
  for (CellIndex c = 0; c < coarse.n_cells(); ++c)
    cells.emplace_back(coarse.topology().cell_nodes(c).begin(),
                       coarse.topology().cell_nodes(c).end());
  std::vector<NodeIndex> number(fine.n_nodes());
  for (NodeIndex i = 0; i < fine.n_nodes(); ++i) {
    const Point<3> p = fine.coordinates()[i] / n + Point<3>(0, 0, 1);
    const auto same = std::find(parts.coordinates.begin(), parts.coordinates.end(), p);
    number[i] = static_cast<NodeIndex>(same - parts.coordinates.begin());
    if (same == parts.coordinates.end()) parts.coordinates.push_back(p);
  }
  for (CellIndex c = 0; c < fine.n_cells(); ++c) {
    auto& cell = cells.emplace_back();
    for (const NodeIndex i : fine.topology().cell_nodes(c)) cell.push_back(number[i]);
  }
  parts.elements[3].nodes = rows_of(cells);
  return parts;
}

/// Two copies of a mesh next to each other in direction x, with the nodes of the seam twice.
inline MeshParts with_seam(const MeshView& mesh, double width) {
  MeshParts parts = sick_parts(mesh);
  ElementList& list = parts.elements[mesh.dimension()];
  const auto n = static_cast<NodeIndex>(parts.coordinates.size());
  for (NodeIndex i = 0; i < n; ++i)
    parts.coordinates.emplace_back(parts.coordinates[i] + Point<3>(width, 0, 0));
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    std::vector<NodeIndex> cell;
    for (const NodeIndex i : mesh.topology().cell_nodes(c)) cell.push_back(n + i);
    list.nodes.append(cell);
  }
  return parts;
}

}  // namespace smoothfem::test
