// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/getme/independent_cells.h"

#include <algorithm>
#include <numeric>

namespace smoothfem {

namespace {

/// Candidates whose neighbourhoods have a cell in common.
struct Neighbours {
  std::uint32_t first, second;
};

/// Finds candidates at the same cells.
class Meetings {
 public:
  Meetings(std::vector<std::uint32_t>& last_at, std::size_t n_candidates)
      : last_at_(last_at), n_candidates_(n_candidates), met_(n_candidates * n_candidates, 0) {}
  ~Meetings() {
    for (const Visit& visit : visits_) last_at_[visit.cell] = 0;
  }
  Meetings(const Meetings&) = delete;
  Meetings& operator=(const Meetings&) = delete;

  /// Adds a cell of the neighbourhood of a candidate; candidates come one after the other.
  void add(CellIndex cell, std::uint32_t candidate) {
    const std::uint32_t last = last_at_[cell];
    if (last != 0 && visits_[last - 1].candidate == candidate) return;
    for (std::uint32_t v = last; v != 0; v = visits_[v - 1].before)
      met_[n_candidates_ * visits_[v - 1].candidate + candidate] = 1;
    visits_.push_back({cell, candidate, last});
    last_at_[cell] = static_cast<std::uint32_t>(visits_.size());
  }
  std::vector<Neighbours> all() const {
    std::vector<Neighbours> result;
    for (std::uint32_t a = 0; a < n_candidates_; ++a)
      for (std::uint32_t b = 0; b < n_candidates_; ++b)
        if (met_[n_candidates_ * a + b]) result.push_back({a, b});
    return result;
  }

 private:
  struct Visit {
    CellIndex cell;
    std::uint32_t candidate;
    std::uint32_t before;  ///< number of the visit before at this cell; 0: none
  };
  std::vector<std::uint32_t>& last_at_;
  std::vector<Visit> visits_;  ///< their numbers begin with 1
  std::size_t n_candidates_;
  std::vector<std::uint8_t> met_;  ///< of each pair
};

}  // namespace

std::vector<KeyedCell> lowest_cells(const WholeMesh& whole, const MinTree& keys, std::size_t n) {
  std::vector<KeyedCell> lowest;
  if (keys.size() > 0)
    for (const CellIndex c : keys.lowest(n)) lowest.push_back({keys.key(c), whole.cell_number(c)});
  lowest.resize(n, {MinTree::never, 0});
  whole.keep_lowest(lowest);
  std::erase_if(lowest, [](const KeyedCell& cell) { return cell.key == MinTree::never; });
  return lowest;
}

void IndependentCells::prepare(const Topology& topology) {
  topology_ = &topology;
  last_visits_.assign(topology.n_cells(), 0);
}

std::vector<std::uint32_t> IndependentCells::choose(std::span<const KeyedCell> candidates,
                                                    std::span<const CandidateNode> nodes) {
  const WholeMesh whole(*topology_);
  std::vector<double> second_keys(candidates.size());
  std::vector<std::vector<std::uint32_t>> neighbours(candidates.size());
  {
    Meetings meetings(last_visits_, candidates.size());
    for (const auto& [place, number, second_key] : nodes) {
      second_keys[place] = second_key;
      if (const auto node = whole.find_node(number))
        for (const CellIndex c : topology_->node_cells(*node)) meetings.add(c, place);
    }
    for (const auto& [a, b] : whole.gather(meetings.all())) {
      neighbours[a].push_back(b);
      neighbours[b].push_back(a);
    }
  }
  std::vector<std::uint32_t> order(candidates.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(candidates[a].key, second_keys[a]) <
           std::pair(candidates[b].key, second_keys[b]);
  });
  std::vector<std::uint8_t> is_near(candidates.size(), 0);  // to a chosen one
  std::vector<std::uint32_t> chosen;
  for (const std::uint32_t place : order) {
    if (is_near[place]) continue;
    chosen.push_back(place);
    for (const std::uint32_t other : neighbours[place]) is_near[other] = 1;
  }
  return chosen;
}

}  // namespace smoothfem
