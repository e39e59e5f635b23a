// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/getme/neighbour_weights.h"

#include <algorithm>
#include <cmath>

#include "smoothing/base/parallel.h"
#include "smoothing/mesh/parallel_rows.h"

namespace smoothfem {

namespace {

/// Rows of cells with small numbers, in few bytes: the cells that share several nodes with a cell
/// are close to it and to each other in an order of cells that is good for anything. Each is
/// written as a number made of its difference to the one before (to `cell` for the first) and the
/// surplus, by digits of seven bits, low ones first, the eighth bit of all but the last set.
class SharedCellCode {
 public:
  static constexpr std::uint64_t largest_surplus = 4;

  explicit SharedCellCode(CellIndex cell) : before_(cell) {}

  /// Surplus: 1 to largest_surplus.
  void append(CellIndex other, std::uint64_t surplus, std::vector<std::uint8_t>& row) {
    const std::uint64_t down = other < before_;
    const std::uint64_t difference = down ? before_ - other : other - before_;
    before_ = other;
    std::uint64_t number = (difference << 1 | down) * largest_surplus + (surplus - 1);
    for (; number >= more; number /= more) row.push_back(static_cast<std::uint8_t>(number | more));
    row.push_back(static_cast<std::uint8_t>(number));
  }

  /// Calls use(other, surplus) for all that were appended to a row.
  template <class Use>
  void read(std::span<const std::uint8_t> row, const Use& use) {
    for (auto digit = row.begin(); digit != row.end(); ++digit) {
      std::uint64_t number = *digit % more;
      for (unsigned shift = 7; *digit >= more; shift += 7)
        number |= static_cast<std::uint64_t>(*++digit % more) << shift;
      const std::uint64_t move = number / largest_surplus;
      const auto difference = static_cast<CellIndex>(move >> 1);
      before_ = move & 1 ? before_ - difference : before_ + difference;
      use(before_, number % largest_surplus + 1);
    }
  }

 private:
  static constexpr std::uint64_t more = 128;  ///< the bit that says that another digit follows

  CellIndex before_;
};

/// Finds the cells that share several nodes with a cell. Counts them, which is faster than
/// sorting: the numbers of the cells around a cell lie close together in meshes that are
/// large enough for it to matter.
class SharedCells {
 public:
  /// Appends them to an empty row, ascending.
  void find(const Topology& topology, CellIndex cell, std::vector<std::uint8_t>& row) {
    CellIndex first = cell, last = cell;
    for (const NodeIndex node : topology.cell_nodes(cell)) {
      const auto cells = topology.node_cells(node);
      first = std::min(first, cells.front());
      last = std::max(last, cells.back());
    }
    if (counts_.size() <= last - first) counts_.resize(last - first + 1, 0);
    shared_.clear();
    for (const NodeIndex node : topology.cell_nodes(cell))
      for (const CellIndex other : topology.node_cells(node))
        if (++counts_[other - first] == 2) shared_.push_back(other);
    std::sort(shared_.begin(), shared_.end());
    SharedCellCode code(cell);
    for (const CellIndex other : shared_)
      for (std::uint64_t surplus = counts_[other - first] - 1; other != cell && surplus > 0;) {
        const auto part = std::min(surplus, SharedCellCode::largest_surplus);
        code.append(other, part, row);
        surplus -= part;
      }
    for (const NodeIndex node : topology.cell_nodes(cell))
      for (const CellIndex other : topology.node_cells(node)) counts_[other - first] = 0;
  }

 private:
  std::vector<std::uint32_t> counts_;  ///< of the nodes that cells share; zero between two calls
  std::vector<CellIndex> shared_;
};

}  // namespace

void NeighbourWeights::prepare(std::shared_ptr<const Topology> topology) {
  if (topology == topology_) return;
  topology_ = std::move(topology);
  counted_too_often_ = make_rows<std::uint8_t>(
      topology_->n_cells(), [&](std::size_t cell, std::vector<std::uint8_t>& row) {
        thread_local SharedCells shared;
        shared.find(*topology_, static_cast<CellIndex>(cell), row);
      });
  node_sums_.resize(topology_->n_nodes());
  weights_.assign(topology_->n_cells(), 1.0);
}

void NeighbourWeights::compute(std::span<const CellIndex> cells,
                               const std::vector<double>& cell_quality) {
  const bool all = cells.size() == topology_->n_cells();
  is_needed_.assign(topology_->n_nodes(), all);
  if (!all)
    for (const CellIndex c : cells)
      for (const NodeIndex node : topology_->cell_nodes(c)) is_needed_[node] = 1;
  constexpr std::size_t grain = 4096;
  parallel_for_ranges(topology_->n_nodes(), grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (!is_needed_[i]) continue;
      double sum = 0.0;
      for (const CellIndex c : topology_->node_cells(static_cast<NodeIndex>(i)))
        sum += cell_quality[c];
      node_sums_[i] = sum;
    }
  });
  parallel_for_ranges(cells.size(), grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) weights_[cells[i]] = weight(cells[i], cell_quality);
  });
}

double NeighbourWeights::weight(CellIndex cell, const std::vector<double>& cell_quality) const {
  double sum = 0.0;
  std::size_t count = 0;
  const auto nodes = topology_->cell_nodes(cell);
  for (const NodeIndex node : nodes) {
    sum += node_sums_[node];
    count += topology_->node_cells(node).size();
  }
  sum -= static_cast<double>(nodes.size()) * cell_quality[cell];
  count -= nodes.size();
  SharedCellCode(cell).read(counted_too_often_[cell], [&](CellIndex other, std::uint64_t surplus) {
    sum -= static_cast<double>(surplus) * cell_quality[other];
    count -= surplus;
  });
  if (count == 0) return 1.0;
  return std::sqrt(std::max(sum, 0.0) / (static_cast<double>(count) * cell_quality[cell]));
}

}  // namespace smoothfem
