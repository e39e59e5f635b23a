// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "smoothing/base/parallel.h"
#include "smoothing/mesh/topology.h"
#include "smoothing/parts/exact_sum.h"
#include "smoothing/parts/mesh_part.h"

namespace smoothfem {

/// The rows of the unknown nodes of a mesh or of its part, in vectors and matrices. A part has rows
/// of its own nodes and of copied ones around them. Only its own are complete. Sums and loops are
/// over these; others get their owners' values by update().
class UnknownRows {
 public:
  /// No rows.
  UnknownRows() = default;
  /// nodes: that of each row.
  UnknownRows(const Topology& topology, const std::vector<NodeIndex>& nodes)
      : n_(nodes.size()), part_(topology.part()), n_nodes_(topology.n_nodes()) {
    if (part_) nodes_ = nodes;
  }

  /// Null if this is the whole mesh.
  const MeshPart* part() const { return part_; }

  /// Calls work(row) for all rows. Several threads run only if there are enough rows: otherwise
  /// waiting for each other at the end of every loop costs more than it gains.
  template <class Work>
  void for_each(const Work& work) const {
    for_ranges([&](std::size_t first, std::size_t last) {
      for (std::size_t row = first; row < last; ++row)
        if (owns(row)) work(row);
    });
  }

  /// Returns the sum over all rows of the whole mesh, the same for every number of threads; in a
  /// part, of processes, too. add(row, sum): adds the row's terms. Collective.
  template <class Add>
  double sum(const Add& add) const {
    if (part_ == nullptr) {
      std::vector<double> parts((n_ + grain - 1) / grain);
      for_ranges([&](std::size_t first, std::size_t last) {
        double sum = 0.0;
        for (std::size_t row = first; row < last; ++row) add(row, sum);
        parts[first / grain] = sum;
      });
      double sum = 0.0;
      for (const double value : parts) sum += value;
      return sum;
    }
    std::vector<ExactSum> parts((n_ + grain - 1) / grain);
    for_ranges([&](std::size_t first, std::size_t last) {
      for (std::size_t row = first; row < last; ++row) {
        if (!owns(row)) continue;
        double term = 0.0;
        add(row, term);
        parts[first / grain].add(term);
      }
    });
    ExactSum sum;
    for (const ExactSum& value : parts) sum.add(value);
    return sum.total(*part_);
  }

  /// Gives copied rows the values of their owners. of_rows: Eigen's matrices of fixed size. Nothing
  /// happens in a whole mesh. Collective.
  template <class Entry>
  void update(std::vector<Entry>& of_rows) const {
    if (part_ == nullptr) return;
    constexpr auto n = static_cast<std::size_t>(Entry::SizeAtCompileTime);
    std::vector<double> of_nodes(n * n_nodes_);
    for (std::size_t row = 0; row < n_; ++row)
      std::copy_n(of_rows[row].data(), n, &of_nodes[n * nodes_[row]]);
    part_->update(of_nodes, n);
    for (std::size_t row = 0; row < n_; ++row)
      if (!owns(row)) std::copy_n(&of_nodes[n * nodes_[row]], n, of_rows[row].data());
  }

 private:
  /// Number of rows that one thread takes at a time; it fixes the order of sums over rows.
  static constexpr std::size_t grain = 1024;

  bool owns(std::size_t row) const { return part_ == nullptr || part_->owns_node(nodes_[row]); }
  template <class Work>
  void for_ranges(const Work& work) const {
    constexpr std::size_t min_rows = 16384;
    if (n_ >= min_rows) return parallel_for_ranges(n_, grain, work);
    for (std::size_t first = 0; first < n_; first += grain)
      work(first, std::min(first + grain, n_));
  }

  std::size_t n_ = 0;
  const MeshPart* part_ = nullptr;
  std::size_t n_nodes_ = 0;         ///< of the part
  std::vector<NodeIndex> nodes_{};  ///< of each row, in a part
};

}  // namespace smoothfem
