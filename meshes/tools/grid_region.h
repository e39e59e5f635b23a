// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "meshes/tools/mesh_cells.h"
#include "meshes/tools/outline.h"

namespace smoothfem {

/// The squares of a regular grid that lie inside a region, as a set that can lose single squares.
class GridRegion {
 public:
  /// Takes the squares whose corners all lie inside the first polygon and outside the others,
  /// without squares that would touch others at a corner only. The lines begin half a spacing
  /// inside the box around the first polygon.
  GridRegion(const Polygons& polygons, double spacing);

  std::size_t n_cells() const { return n_cells_; }
  std::size_t n_boundary_edges() const { return n_boundary_edges_; }

  /// Removes n squares, chosen at random among those with n_neighbours neighbours (2 or 3), without
  /// changing the numbers of parts and of holes. Each adds 0 or 2 boundary edges. Returns the
  /// number of squares found.
  std::size_t remove(std::size_t n, int n_neighbours, std::uint64_t seed);

  /// Returns the squares, row by row.
  PlanarCells cells() const;

 private:
  std::size_t index(std::size_t i, std::size_t j) const { return i + n_x_ * j; }
  int n_neighbours(std::size_t cell) const;
  bool can_be_removed(std::size_t cell) const;
  void erase_pinches();

  double spacing_;
  Point<2> origin_;
  std::size_t n_x_ = 0, n_y_ = 0;  // with an empty frame
  std::vector<std::uint8_t> is_in_;
  std::size_t n_cells_ = 0, n_boundary_edges_ = 0;
};

}  // namespace smoothfem
