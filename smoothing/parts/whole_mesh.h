// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "smoothing/mesh/topology.h"
#include "smoothing/parts/mesh_part.h"

namespace smoothfem {

/// The whole mesh, as code sees it that works in a part of it and in a whole mesh alike. Numbers
/// are then those of the mesh itself, this process owns all, and nothing is exchanged.
class WholeMesh {
 public:
  explicit WholeMesh(const Topology& topology) : part_(topology.part()) {}

  GlobalIndex node_number(NodeIndex node) const { return part_ ? part_->nodes()[node] : node; }
  GlobalIndex cell_number(CellIndex cell) const { return part_ ? part_->cells()[cell] : cell; }
  /// Return the node or cell here that has a number in the whole mesh, or nothing.
  std::optional<NodeIndex> find_node(GlobalIndex number) const {
    return part_ ? find(part_->nodes(), number) : number;
  }
  std::optional<CellIndex> find_cell(GlobalIndex number) const {
    return part_ ? find(part_->cells(), number) : number;
  }
  bool owns_cell(CellIndex cell) const { return part_ == nullptr || part_->owns_cell(cell); }
  bool owns_node(NodeIndex node) const { return part_ == nullptr || part_->owns_node(node); }

  /// See MeshPart. Collective.
  template <class T>
  std::vector<T> gather(std::vector<T> items) const {
    return part_ ? part_->gather(items) : items;
  }
  void keep_lowest(std::span<KeyedCell> cells) const {
    if (part_) part_->keep_lowest(cells);
  }
  void sum(std::span<std::int64_t> values) const {
    if (part_) part_->sum(values);
  }
  double min(double value) const {
    if (part_) part_->min({&value, 1});
    return value;
  }

 private:
  static std::optional<std::uint32_t> find(std::span<const GlobalIndex> numbers,
                                           GlobalIndex number) {
    const auto place = std::lower_bound(numbers.begin(), numbers.end(), number);
    if (place == numbers.end() || *place != number) return std::nullopt;
    return static_cast<std::uint32_t>(place - numbers.begin());
  }

  const MeshPart* part_;
};

}  // namespace smoothfem
