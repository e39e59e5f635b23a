// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "smoothing/mesh/element_type.h"

namespace smoothfem {

/// What one rank's part of a distributed mesh shares with the parts of other ranks.
///
/// Each node and each cell of the whole mesh has one owner. A part has the nodes and cells that its
/// rank owns, all cells around its own nodes, and the other nodes of these cells. So the owner of a
/// node has all that decides where it moves. Other parts have copies of the node, which update()
/// overwrites by the owner's. Local numbers ascend with those of the whole mesh. Then sums over the
/// cells or neighbours of a node have the same order in every part.
///
/// Functions with communication are collective: all ranks call them in the same order.
class MeshPart {
 public:
  virtual ~MeshPart() = default;

  bool owns_node(NodeIndex node) const { return owns_node_[node] != 0; }
  bool owns_cell(CellIndex cell) const { return owns_cell_[cell] != 0; }
  /// Returns the number of cells of the whole mesh.
  std::size_t n_cells_of_whole() const { return n_cells_of_whole_; }

  /// Overwrites the values of copied nodes by those of their owners. values: n for each node of the
  /// part, one node after the other.
  virtual void update(std::span<double> values, std::size_t n) const = 0;
  /// Replace each number by its sum, its smallest or its largest value over all ranks.
  virtual void sum(std::span<std::int64_t> values) const = 0;
  virtual void min(std::span<double> values) const = 0;
  virtual void max(std::span<double> values) const = 0;

  double max(double value) const {
    max({&value, 1});
    return value;
  }
  std::size_t sum(std::size_t value) const {
    auto total = static_cast<std::int64_t>(value);
    sum({&total, 1});
    return static_cast<std::size_t>(total);
  }
  /// True if this holds on any rank.
  bool any(bool value) const { return sum(std::size_t{value}) > 0; }

 protected:
  /// Flags for the nodes and cells of this part.
  MeshPart(std::vector<std::uint8_t> owns_node, std::vector<std::uint8_t> owns_cell,
           std::size_t n_cells_of_whole)
      : owns_node_(std::move(owns_node)),
        owns_cell_(std::move(owns_cell)),
        n_cells_of_whole_(n_cells_of_whole) {}

 private:
  std::vector<std::uint8_t> owns_node_, owns_cell_;
  std::size_t n_cells_of_whole_;
};

}  // namespace smoothfem
