// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "smoothing/mesh/element_type.h"
#include "smoothing/parts/global_index.h"

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
  /// Numbers of the part's nodes and cells in the whole mesh, ascending.
  std::span<const GlobalIndex> nodes() const { return nodes_; }
  std::span<const GlobalIndex> cells() const { return cells_; }

  /// Overwrites the values of copied nodes by those of their owners. values: n for each node of the
  /// part, one node after the other.
  virtual void update(std::span<double> values, std::size_t n) const = 0;
  /// Replaces the value of each cell by the sum over all its copies, in any order. values: one for
  /// each cell of the part.
  virtual void sum_copies_of_cells(std::span<double> values) const = 0;
  /// Replace each number by its sum, its smallest or its largest value over all ranks.
  virtual void sum(std::span<std::int64_t> values) const = 0;
  virtual void min(std::span<double> values) const = 0;
  virtual void max(std::span<double> values) const = 0;
  /// Returns the items of all ranks, one rank's after the other's.
  template <class T>
  std::vector<T> gather(const std::vector<T>& items) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto bytes = gather_bytes(std::as_bytes(std::span(items)));
    std::vector<T> all(bytes.size() / sizeof(T));
    if (!all.empty()) std::memcpy(all.data(), bytes.data(), bytes.size());
    return all;
  }
  /// Replaces ascending cells by the lowest ones of all ranks. Each rank passes the same number.
  virtual void keep_lowest(std::span<KeyedCell> cells) const = 0;

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
  /// Numbers in the whole mesh, and flags, of the nodes and cells of this part.
  MeshPart(std::vector<GlobalIndex> nodes, std::vector<std::uint8_t> owns_node,
           std::vector<GlobalIndex> cells, std::vector<std::uint8_t> owns_cell,
           std::size_t n_cells_of_whole)
      : nodes_(std::move(nodes)),
        cells_(std::move(cells)),
        owns_node_(std::move(owns_node)),
        owns_cell_(std::move(owns_cell)),
        n_cells_of_whole_(n_cells_of_whole) {}

 private:
  virtual std::vector<std::byte> gather_bytes(std::span<const std::byte> bytes) const = 0;

  std::vector<GlobalIndex> nodes_, cells_;
  std::vector<std::uint8_t> owns_node_, owns_cell_;
  std::size_t n_cells_of_whole_;
};

}  // namespace smoothfem
