// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/grid_region.h"

#include <array>
#include <cmath>

#include "meshes/distortion/counter_random.h"

namespace smoothfem {

namespace {

/// Counts the sides that a ray to the right crosses.
bool is_inside(const Polygons& polygons, const Point<2>& p) {
  bool inside = false;
  for (const auto& polygon : polygons)
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Point<2>&a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      if ((a.y() > p.y()) == (b.y() > p.y())) continue;
      const double x = a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      if (p.x() < x) inside = !inside;
    }
  return inside;
}

}  // namespace

GridRegion::GridRegion(const Polygons& polygons, double spacing) : spacing_(spacing) {
  Point<2> low = polygons.front().front(), high = low;
  for (const Point<2>& p : polygons.front()) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  origin_ = low - Point<2>(1.5, 1.5) * spacing;
  const Point<2> size = (high - low) / spacing;
  n_x_ = static_cast<std::size_t>(std::ceil(size.x())) + 3;
  n_y_ = static_cast<std::size_t>(std::ceil(size.y())) + 3;
  std::vector<std::uint8_t> inside((n_x_ + 1) * (n_y_ + 1));
  const auto corner = [&](std::size_t i, std::size_t j) -> std::uint8_t& {
    return inside[i + (n_x_ + 1) * j];
  };
  for (std::size_t j = 0; j <= n_y_; ++j)
    for (std::size_t i = 0; i <= n_x_; ++i)
      corner(i, j) = is_inside(polygons, origin_ + spacing * Point<2>(i, j)) ? 1 : 0;
  is_in_.assign(n_x_ * n_y_, 0);
  for (std::size_t j = 1; j + 1 < n_y_; ++j)
    for (std::size_t i = 1; i + 1 < n_x_; ++i)
      is_in_[index(i, j)] =
          corner(i, j) & corner(i + 1, j) & corner(i, j + 1) & corner(i + 1, j + 1);
  erase_pinches();
  for (std::size_t cell = 0; cell < is_in_.size(); ++cell) {
    if (is_in_[cell] == 0) continue;
    ++n_cells_;
    n_boundary_edges_ += static_cast<std::size_t>(4 - n_neighbours(cell));
  }
}

void GridRegion::erase_pinches() {
  for (bool found = true; found;) {
    found = false;
    for (std::size_t j = 0; j + 1 < n_y_; ++j)
      for (std::size_t i = 0; i + 1 < n_x_; ++i) {
        const std::array cells{index(i, j), index(i + 1, j), index(i, j + 1), index(i + 1, j + 1)};
        const auto in = [&](std::size_t k) { return is_in_[cells[k]] != 0; };
        const bool is_pinch = in(0) == in(3) && in(1) == in(2) && in(0) != in(1);
        if (!is_pinch) continue;
        is_in_[cells[in(0) ? 0 : 1]] = 0;
        found = true;
      }
  }
}

int GridRegion::n_neighbours(std::size_t cell) const {
  return is_in_[cell - 1] + is_in_[cell + 1] + is_in_[cell - n_x_] + is_in_[cell + n_x_];
}

/// True if the neighbours inside the region, including those at corners, form one chain around the
/// cell.
bool GridRegion::can_be_removed(std::size_t cell) const {
  const std::array ring{cell + 1, cell + 1 + n_x_, cell + n_x_, cell - 1 + n_x_,
                        cell - 1, cell - 1 - n_x_, cell - n_x_, cell + 1 - n_x_};
  int n_ends = 0;
  for (std::size_t k = 0; k < ring.size(); ++k)
    n_ends += is_in_[ring[k]] != is_in_[ring[(k + 1) % ring.size()]];
  return n_ends == 2;
}

std::size_t GridRegion::remove(std::size_t n, int n_neighbours_wanted, std::uint64_t seed) {
  SplitMix64 random(seed);
  const std::size_t max_tries = 1000 * is_in_.size();
  std::size_t n_removed = 0;
  for (std::size_t i = 0; i < max_tries && n_removed < n; ++i) {
    const auto cell = static_cast<std::size_t>(random.below(is_in_.size()));
    if (is_in_[cell] == 0 || n_neighbours(cell) != n_neighbours_wanted || !can_be_removed(cell))
      continue;
    is_in_[cell] = 0;
    ++n_removed;
    --n_cells_;
    n_boundary_edges_ += static_cast<std::size_t>(2 * (n_neighbours_wanted - 2));
  }
  return n_removed;
}

PlanarCells GridRegion::cells() const {
  PlanarCells mesh;
  std::vector<std::uint8_t> used((n_x_ + 1) * (n_y_ + 1), 0);
  const auto corners = [&](std::size_t cell) {
    const std::size_t i = cell % n_x_, j = cell / n_x_, a = i + (n_x_ + 1) * j, b = a + n_x_ + 1;
    return std::array{a, a + 1, b + 1, b};
  };
  for (std::size_t cell = 0; cell < is_in_.size(); ++cell)
    for (const std::size_t corner : corners(cell)) used[corner] |= is_in_[cell];
  std::vector<NodeIndex> number(used.size());
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] == 0) continue;
    number[i] = static_cast<NodeIndex>(mesh.coordinates.size());
    mesh.coordinates.push_back(origin_ + spacing_ * Point<2>(i % (n_x_ + 1), i / (n_x_ + 1)));
  }
  for (std::size_t cell = 0; cell < is_in_.size(); ++cell) {
    if (is_in_[cell] == 0) continue;
    std::vector<NodeIndex> row;
    for (const std::size_t corner : corners(cell)) row.push_back(number[corner]);
    mesh.cells.append(row);
  }
  return mesh;
}

}  // namespace smoothfem
