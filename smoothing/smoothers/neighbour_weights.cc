#include "smoothing/smoothers/neighbour_weights.h"

#include <algorithm>
#include <cmath>

#include "smoothing/mesh/input_error.h"
#include "smoothing/mesh/parallel.h"
#include "smoothing/mesh/parallel_rows.h"

namespace smoothfem {

namespace {

constexpr std::uint32_t count_bits = 4, largest_count = (1u << count_bits) - 1;

/// The cells of a cell's nodes, ascending, each as often as it shares a node: merges the nodes'
/// rows, which is faster than sorting.
class CellsAround {
 public:
  const std::vector<CellIndex>& find(const Topology& topology, CellIndex cell) {
    cells_.clear();
    ends_.assign(1, 0);
    for (const NodeIndex node : topology.cell_nodes(cell)) {
      const auto row = topology.node_cells(node);
      cells_.insert(cells_.end(), row.begin(), row.end());
      ends_.push_back(cells_.size());
    }
    while (ends_.size() > 2) merge_pairs();
    return cells_;
  }

 private:
  void merge_pairs() {
    merged_.resize(cells_.size());
    std::size_t n_ends = 1;
    for (std::size_t r = 0; r + 1 < ends_.size(); r += 2) {
      const auto at = [&](std::size_t end) {
        return cells_.begin() + static_cast<std::ptrdiff_t>(ends_[end]);
      };
      const std::size_t last = std::min(r + 2, ends_.size() - 1);
      std::merge(at(r), at(r + 1), at(r + 1), at(last),
                 merged_.begin() + static_cast<std::ptrdiff_t>(ends_[r]));
      ends_[n_ends++] = ends_[last];
    }
    ends_.resize(n_ends);
    cells_.swap(merged_);
  }

  std::vector<CellIndex> cells_, merged_;
  std::vector<std::size_t> ends_;  ///< of the runs that are sorted, behind a 0
};

/// The cells that share several nodes with a cell, coded as NeighbourWeights has them.
void find_shared(const Topology& topology, CellIndex cell, std::vector<std::uint32_t>& row) {
  thread_local CellsAround around;
  const auto& found = around.find(topology, cell);
  for (std::size_t first = 0; first < found.size();) {
    std::size_t last = first + 1;
    while (last < found.size() && found[last] == found[first]) ++last;
    if (found[first] != cell)
      for (auto surplus = static_cast<std::uint32_t>(last - first - 1); surplus > 0;) {
        const std::uint32_t count = std::min(surplus, largest_count);
        row.push_back(found[first] << count_bits | count);
        surplus -= count;
      }
    first = last;
  }
}

}  // namespace

void NeighbourWeights::prepare(std::shared_ptr<const Topology> topology) {
  if (topology == topology_) return;
  if (topology->n_cells() >> (32 - count_bits) != 0)
    throw InputError("GETMe adaptive takes at most " +
                     std::to_string(std::size_t{1} << (32 - count_bits)) + " cells");
  topology_ = std::move(topology);
  counted_too_often_ = make_large_rows<std::uint32_t>(
      topology_->n_cells(), [&](std::size_t cell, std::vector<std::uint32_t>& row) {
        find_shared(*topology_, static_cast<CellIndex>(cell), row);
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
