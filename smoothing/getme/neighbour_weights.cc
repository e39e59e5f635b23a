// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/getme/neighbour_weights.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "smoothing/base/parallel.h"
#include "smoothing/mesh/parallel_rows.h"
#include "smoothing/parts/mesh_part.h"

namespace smoothfem {

namespace {

/// Compresses rows of ascending cell numbers with small counts to two bytes an entry. Cells that
/// share several nodes are close together in any good order of cells. An entry is four times the
/// step from the previous cell, plus the surplus less one. The first step starts at the row's own
/// cell and may go either way. Longer steps take several entries.
class SharedCellCode {
 public:
  static constexpr std::uint32_t largest_surplus = 4;

  explicit SharedCellCode(CellIndex cell) : before_(cell) {}

  /// Appends an entry. surplus: 1 to largest_surplus.
  void append(CellIndex other, std::uint32_t surplus, std::vector<std::uint16_t>& row) {
    const bool back = other < before_;
    std::uint64_t step = back ? before_ - other : other - before_;
    if (row.empty()) step = 2 * step + back;
    before_ = other;
    for (; step >= longest; step -= longest) row.push_back(longest * largest_surplus);
    row.push_back(static_cast<std::uint16_t>(step * largest_surplus + surplus - 1));
  }

  /// Calls use(other, surplus) for all entries of the row of a cell.
  template <class Use>
  static void read(CellIndex cell, std::span<const std::uint16_t> row, const Use& use) {
    if (row.empty()) return;
    auto code = row.begin();
    const auto step = [&] {
      std::uint64_t sum = 0;
      for (; *code / largest_surplus == longest; ++code) sum += longest;
      return sum + *code / largest_surplus;
    };
    const std::uint64_t first = step();
    std::uint64_t other = first % 2 == 1 ? cell - first / 2 : cell + first / 2;
    while (true) {
      use(other, *code % largest_surplus + 1);
      if (++code == row.end()) return;
      other += step();
    }
  }

 private:
  static constexpr std::uint16_t longest = 0x3fff;  ///< as a step: another step follows

  CellIndex before_;
};

/// Set of numbers from 0 .. n-1 that are taken out in ascending order. Keeps a bit for each number,
/// and a bit for each word that has some.
class AscendingNumbers {
 public:
  /// Changes n. Requires that all numbers were taken out.
  void resize(std::size_t n) {
    words_.resize(n / n_bits + 1, 0);
    used_words_.resize(words_.size() / n_bits + 1, 0);
  }
  /// Adds a number if `condition`, without a branch.
  void add_if(bool condition, std::size_t number) {
    words_[number / n_bits] |= std::uint64_t{condition} << number % n_bits;
    used_words_[number / n_bits / n_bits] |= std::uint64_t{condition} << number / n_bits % n_bits;
  }
  template <class Use>
  void take_out(const Use& use) {
    for (std::size_t i = 0; i < used_words_.size(); ++i)
      take_bits(used_words_[i], n_bits * i,
                [&](std::size_t word) { take_bits(words_[word], n_bits * word, use); });
  }

 private:
  static constexpr std::size_t n_bits = 64;

  template <class Use>
  static void take_bits(std::uint64_t& word, std::size_t first, const Use& use) {
    for (; word != 0; word &= word - 1)
      use(first + static_cast<std::size_t>(std::countr_zero(word)));
  }

  std::vector<std::uint64_t> words_, used_words_;
};

/// Finds the cells that share several nodes with a cell, by counting. In large meshes the numbers
/// of the cells around a cell lie close together. In a part of a mesh, only those whose first
/// common node, in the order of the cell's corners, is the part's own: each pair of cells is then
/// found in one part.
class SharedCells {
 public:
  /// Appends them to an empty row, ascending. Returns the number of cells that share a node or
  /// more.
  std::size_t find(const Topology& topology, CellIndex cell, std::vector<std::uint16_t>& row) {
    CellIndex first = cell, last = cell;
    for (const NodeIndex node : topology.cell_nodes(cell)) {
      const auto cells = topology.node_cells(node);
      first = std::min(first, cells.front());
      last = std::max(last, cells.back());
    }
    if (counts_.size() <= last - first) {
      counts_.resize(last - first + 1, 0);
      several_.resize(counts_.size());
    }
    std::size_t n = 0;
    for (const NodeIndex node : topology.cell_nodes(cell)) {
      const bool is_own = topology.part() == nullptr || topology.part()->owns_node(node);
      for (const CellIndex other : topology.node_cells(node)) {
        std::uint32_t& count = counts_[other - first];
        if (count == 0 && !is_own) count = of_another_part;
        ++count;
        n += count == 1 && other != cell;
        several_.add_if(count == 2, other - first);
      }
    }
    SharedCellCode code(cell);
    several_.take_out([&](std::size_t number) {
      const CellIndex other = first + static_cast<CellIndex>(number);
      if (other == cell) return;
      for (std::uint32_t surplus = counts_[number] - 1; surplus > 0;) {
        const auto part = std::min(surplus, SharedCellCode::largest_surplus);
        code.append(other, part, row);
        surplus -= part;
      }
    });
    for (const NodeIndex node : topology.cell_nodes(cell))
      for (const CellIndex other : topology.node_cells(node)) counts_[other - first] = 0;
    return n;
  }

 private:
  static constexpr std::uint32_t of_another_part = 0x80000000;  ///< keeps counts from being low

  std::vector<std::uint32_t> counts_;  ///< numbers of shared nodes by cell; zero between two calls
  AscendingNumbers several_;  ///< positions where counts_ is 2 or more; empty between two calls
};

}  // namespace

void NeighbourWeights::prepare(std::shared_ptr<const Topology> topology) {
  if (topology == topology_) return;
  topology_ = std::move(topology);
  n_neighbours_.resize(topology_->n_cells());
  counted_too_often_ = make_rows<std::uint16_t>(
      topology_->n_cells(), [&](std::size_t cell, std::vector<std::uint16_t>& row) {
        thread_local SharedCells shared;
        n_neighbours_[cell] =
            static_cast<std::uint32_t>(shared.find(*topology_, static_cast<CellIndex>(cell), row));
      });
  node_sums_.resize(topology_->n_nodes());
  weights_.assign(topology_->n_cells(), 1.0);
  if (const MeshPart* part = topology_->part()) {
    surplus_.assign(n_neighbours_.begin(), n_neighbours_.end());
    part->sum_copies_of_cells(surplus_);
    std::transform(surplus_.begin(), surplus_.end(), n_neighbours_.begin(),
                   [](double n) { return static_cast<std::uint32_t>(n); });
  }
}

void NeighbourWeights::compute(std::span<const CellIndex> cells,
                               const std::vector<double>& cell_quality) {
  if (topology_->part()) return compute_in_part(cell_quality);
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
  if (n_neighbours_[cell] == 0) return 1.0;
  const auto nodes = topology_->cell_nodes(cell);
  double sum = 0.0;
  for (const NodeIndex node : nodes) sum += node_sums_[node];
  sum -= static_cast<double>(nodes.size()) * cell_quality[cell];
  SharedCellCode::read(cell, counted_too_often_[cell],
                       [&](std::size_t other, std::uint32_t surplus) {
                         sum -= static_cast<double>(surplus) * cell_quality[other];
                       });
  return std::sqrt(std::max(sum, 0.0) /
                   (static_cast<double>(n_neighbours_[cell]) * cell_quality[cell]));
}

/// Qualities are rounded to multiples of 2^-40, so that the parts' sums are exact.
void NeighbourWeights::compute_in_part(const std::vector<double>& cell_quality) {
  constexpr double shift = 0x1.8p12;
  constexpr std::size_t grain = 4096;
  const MeshPart& part = *topology_->part();
  rounded_.resize(cell_quality.size());
  std::transform(cell_quality.begin(), cell_quality.end(), rounded_.begin(),
                 [](double q) { return (q + shift) - shift; });
  parallel_for_ranges(topology_->n_nodes(), grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      node_sums_[i] = 0.0;
      for (const CellIndex c : topology_->node_cells(static_cast<NodeIndex>(i)))
        node_sums_[i] += rounded_[c];
    }
  });
  part.update(node_sums_, 1);
  parallel_for_ranges(topology_->n_cells(), grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      surplus_[c] = 0.0;
      SharedCellCode::read(static_cast<CellIndex>(c), counted_too_often_[c],
                           [&](std::size_t other, std::uint32_t surplus) {
                             surplus_[c] += static_cast<double>(surplus) * rounded_[other];
                           });
    }
  });
  part.sum_copies_of_cells(surplus_);
  parallel_for_ranges(topology_->n_cells(), grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      if (n_neighbours_[c] == 0) continue;
      const auto nodes = topology_->cell_nodes(static_cast<CellIndex>(c));
      double sum = -surplus_[c] - static_cast<double>(nodes.size()) * rounded_[c];
      for (const NodeIndex node : nodes) sum += node_sums_[node];
      weights_[c] =
          std::sqrt(std::max(sum, 0.0) / (static_cast<double>(n_neighbours_[c]) * cell_quality[c]));
    }
  });
}

}  // namespace smoothfem
