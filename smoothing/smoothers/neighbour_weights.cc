#include "smoothing/smoothers/neighbour_weights.h"

#include <algorithm>
#include <cmath>

#include "smoothing/mesh/input_error.h"
#include "smoothing/mesh/parallel.h"
#include "smoothing/mesh/parallel_rows.h"

namespace smoothfem {

namespace {

constexpr std::uint32_t count_bits = 4, largest_count = (1u << count_bits) - 1;

/// Finds the cells that share several nodes with a cell. Counts them, which is faster than
/// sorting: the numbers of the cells around a cell lie close together in meshes that are
/// large enough for it to matter.
class SharedCells {
 public:
  /// Appends them to an empty row, coded as NeighbourWeights has them, ascending.
  void find(const Topology& topology, CellIndex cell, std::vector<std::uint32_t>& row) {
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
    for (const CellIndex other : shared_)
      for (std::uint32_t surplus = counts_[other - first] - 1; other != cell && surplus > 0;) {
        const std::uint32_t part = std::min(surplus, largest_count);
        row.push_back(other << count_bits | part);
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
  if (topology->n_cells() >> (32 - count_bits) != 0)
    throw InputError("GETMe adaptive takes at most " +
                     std::to_string(std::size_t{1} << (32 - count_bits)) + " cells");
  topology_ = std::move(topology);
  counted_too_often_ = make_rows<std::uint32_t>(
      topology_->n_cells(), [&](std::size_t cell, std::vector<std::uint32_t>& row) {
        thread_local SharedCells shared;
        shared.find(*topology_, static_cast<CellIndex>(cell), row);
      });
  node_sums_.resize(topology_->n_nodes());
  weights_.assign(topology_->n_cells(), 1.0);
}

void NeighbourWeights::compute(std::span<const CellIndex> cells,
                               const std::vector<double>& cell_quality) {
  constexpr std::size_t grain = 4096;
  parallel_for_ranges(topology_->n_nodes(), grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
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
  for (const std::uint32_t entry : counted_too_often_[cell]) {
    const std::uint32_t surplus = entry & largest_count;
    sum -= surplus * cell_quality[entry >> count_bits];
    count -= surplus;
  }
  if (count == 0) return 1.0;
  return std::sqrt(std::max(sum, 0.0) / (static_cast<double>(count) * cell_quality[cell]));
}

}  // namespace smoothfem
