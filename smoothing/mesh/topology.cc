// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/mesh/topology.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string>
#include <tuple>

#include "smoothing/base/input_error.h"
#include "smoothing/base/parallel.h"
#include "smoothing/mesh/parallel_rows.h"
#include "smoothing/mesh/volume_elements.h"
#include "smoothing/parts/mesh_part.h"

namespace smoothfem {

namespace {

constexpr std::size_t grain_of_cells = 4096;  ///< that one thread takes at a time

/// A cell's facet: its nodes, sorted, without the smallest one, by which it is searched for.
struct FacetKey {
  std::array<NodeIndex, 3> others;
  CellIndex cell;
  std::uint32_t position;

  auto order() const { return std::tie(others[0], others[1], others[2], cell); }
  bool same_nodes(const FacetKey& other) const { return others == other.others; }
};

/// Collects the facets whose smallest node is `node`, sorted so that those with the same nodes are
/// adjacent.
void facets_of(NodeIndex node, int dim, std::span<const CellIndex> cells,
               const CompressedRows<NodeIndex>& all_cells, std::vector<FacetKey>& facets) {
  constexpr NodeIndex none = std::numeric_limits<NodeIndex>::max();
  facets.clear();
  for (const CellIndex c : cells) {
    const auto nodes = all_cells[c];
    std::uint32_t position = 0;
    for_each_facet(dim, nodes.size(), [&](std::span<const std::size_t> at) {
      std::array<NodeIndex, 4> sorted{none, none, none, none};
      for (std::size_t k = 0; k < at.size(); ++k) sorted[k] = nodes[at[k]];
      if (*std::min_element(sorted.begin(), sorted.end()) == node) {
        std::sort(sorted.begin(), sorted.end());
        facets.push_back({{sorted[1], sorted[2], sorted[3]}, c, position});
      }
      ++position;
    });
  }
  std::sort(facets.begin(), facets.end(),
            [](const FacetKey& a, const FacetKey& b) { return a.order() < b.order(); });
}

[[noreturn]] void refuse_facet(int dim, NodeIndex node, const FacetKey& facet, std::size_t count) {
  std::string nodes = std::to_string(node);
  std::vector<NodeIndex> others;
  for (const NodeIndex other : facet.others)
    if (other != std::numeric_limits<NodeIndex>::max()) others.push_back(other);
  for (std::size_t k = 0; k < others.size(); ++k)
    nodes += (k + 1 < others.size() ? ", " : " and ") + std::to_string(others[k]);
  throw CellError(facet.cell, "is cell number " + std::to_string(count) + " at the " +
                                  (dim == 2 ? "edge" : "face") + " between nodes " + nodes +
                                  (dim == 2 ? "; at most two planar cells share an edge"
                                            : "; at most two volume cells share a face"));
}

/// Returns a hash of sorted nodes.
std::uint64_t key_of(const std::vector<NodeIndex>& sorted_nodes) {
  std::uint64_t key = sorted_nodes.size();
  for (const NodeIndex node : sorted_nodes) {
    key = (key ^ node) * 0x9e3779b97f4a7c15u;
    key ^= key >> 32;
  }
  return key;
}

/// Throws CellError for a cell that is given twice, its nodes perhaps in another order: it would
/// count twice.
void require_different_cells(const CompressedRows<NodeIndex>& cells,
                             std::vector<std::uint64_t> keys) {
  std::sort(keys.begin(), keys.end());
  if (std::adjacent_find(keys.begin(), keys.end()) == keys.end()) return;
  std::map<std::vector<NodeIndex>, CellIndex> seen;
  for (CellIndex c = 0; c < cells.size(); ++c) {
    std::vector<NodeIndex> nodes(cells[c].begin(), cells[c].end());
    std::sort(nodes.begin(), nodes.end());
    const auto [first, is_new] = seen.emplace(std::move(nodes), c);
    if (!is_new)
      throw CellError(c, "has the same nodes as cell " + std::to_string(first->second) +
                             "; remove one of them");
  }
}

}  // namespace

namespace {

std::vector<FixedReasons> marked(const std::vector<bool>& fixed) {
  std::vector<FixedReasons> reasons(fixed.size());
  for (std::size_t i = 0; i < fixed.size(); ++i)
    reasons[i] = fixed[i] ? bit(FixedReason::marked) : 0;
  return reasons;
}

}  // namespace

Topology::Topology(int dim, std::size_t n_nodes, CompressedRows<NodeIndex> cells,
                   std::optional<std::vector<bool>> fixed, MeshLabels labels)
    : dim_(dim), cells_(std::move(cells)), labels_(std::move(labels)) {
  build(n_nodes, [&] {
    std::vector<FixedReasons> reasons;
    if (fixed) return marked(*fixed);
    for (const bool is_on_boundary : on_boundary_)
      reasons.push_back(is_on_boundary ? bit(FixedReason::boundary) : FixedReasons{0});
    return reasons;
  });
}

Topology::Topology(int dim, std::size_t n_nodes, CompressedRows<NodeIndex> cells,
                   std::vector<FixedReasons> reasons, MeshLabels labels)
    : dim_(dim), cells_(std::move(cells)), labels_(std::move(labels)) {
  build(n_nodes, [&] { return std::move(reasons); });
}

Topology::Topology(int dim, std::size_t n_nodes, CompressedRows<NodeIndex> cells, MeshLabels labels,
                   const std::function<std::vector<FixedReasons>(const Topology&)>& make_reasons)
    : dim_(dim), cells_(std::move(cells)), labels_(std::move(labels)) {
  build(n_nodes, [&] { return make_reasons(*this); });
}

template <class Reasons>
void Topology::build(std::size_t n_nodes, const Reasons& make_reasons) {
  check_cells(n_nodes);
  // Not kept: large meshes are smoothed in another order, and other meshes do not need it any more.
  const auto node_cells = rows_by_entry(cells_, n_nodes);
  build_boundary(node_cells);
  fixed_.resize(n_nodes);  // make_reasons may ask for the number of nodes
  std::vector<FixedReasons> reasons = make_reasons();
  if (reasons.size() != n_nodes)
    throw InputError("the mesh has " + std::to_string(n_nodes) + " nodes but " +
                     std::to_string(reasons.size()) + " fixed flags");
  std::vector<bool> is_midside(n_nodes, false);
  if (const MidsideNodes* nodes = midside()) {
    check_midside_nodes(dim_, n_nodes, cells_, nodes->of_cells);
    for (const NodeIndex node : nodes->of_cells.entries()) is_midside[node] = true;
  }
  for (NodeIndex i = 0; i < n_nodes; ++i)
    if (node_cells[i].empty())
      reasons[i] = is_midside[i] ? bit(FixedReason::midside)
                                 : FixedReasons(reasons[i] | bit(FixedReason::unused));
  build_fixed(std::move(reasons));
  build_blocks();
}

void Topology::check_cells(std::size_t n_nodes) const {
  if (cells_.empty()) throw InputError("the mesh has no cells");
  std::vector<NodeIndex> sorted;
  std::vector<std::uint64_t> keys;
  keys.reserve(cells_.size());
  for (CellIndex c = 0; c < cells_.size(); ++c) {
    const auto nodes = cells_[c];
    if (!is_cell_size(dim_, nodes.size()))
      throw CellError(c, "has " + std::to_string(nodes.size()) + " nodes; " +
                             (dim_ == 2 ? "a planar cell needs at least three"
                                        : "a volume cell has 4, 5, 6 or 8"));
    sorted.assign(nodes.begin(), nodes.end());
    std::sort(sorted.begin(), sorted.end());
    if (sorted.back() >= n_nodes)
      throw CellError(c, "names node " + std::to_string(sorted.back()) +
                             ", but the mesh has only " + std::to_string(n_nodes) +
                             " nodes, counted from 0");
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end())
      throw CellError(c, "names node " + std::to_string(*twice) + " more than once");
    keys.push_back(key_of(sorted));
  }
  require_different_cells(cells_, std::move(keys));
}

void Topology::build_boundary(const CompressedRows<CellIndex>& node_cells) {
  constexpr std::size_t grain = 4096;
  const std::size_t n_nodes = node_cells.size();
  struct Part {
    std::vector<std::pair<CellIndex, std::uint32_t>> boundary;
    std::size_t n_facets = 0;
    bool bad = false;
  };
  // The thread that has a facet's smallest node handles the facet.
  std::vector<Part> parts((n_nodes + grain - 1) / grain);
  const auto visit = [&](Part& part, NodeIndex node, std::vector<FacetKey>& facets, bool refuse) {
    facets_of(node, dim_, node_cells[node], cells_, facets);
    for (std::size_t first = 0; first < facets.size();) {
      std::size_t last = first + 1;
      while (last < facets.size() && facets[last].same_nodes(facets[first])) ++last;
      if (last - first > 2) {
        part.bad = true;
        if (refuse) refuse_facet(dim_, node, facets[last - 1], last - first);
      }
      if (last - first == 1) part.boundary.emplace_back(facets[first].cell, facets[first].position);
      ++part.n_facets;
      first = last;
    }
  };
  parallel_for(parts.size(), [&](std::size_t p) {
    std::vector<FacetKey> facets;
    for (std::size_t i = p * grain; i < std::min(n_nodes, (p + 1) * grain); ++i)
      visit(parts[p], static_cast<NodeIndex>(i), facets, false);
  });
  std::vector<std::pair<CellIndex, std::uint32_t>> boundary;
  std::vector<FacetKey> facets;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (parts[p].bad)  // once more for the sentence, from where it can be thrown
      for (std::size_t i = p * grain; i < std::min(n_nodes, (p + 1) * grain); ++i)
        visit(parts[p], static_cast<NodeIndex>(i), facets, true);
    boundary.insert(boundary.end(), parts[p].boundary.begin(), parts[p].boundary.end());
    n_facets_ += parts[p].n_facets;
  }
  std::sort(boundary.begin(), boundary.end());

  on_boundary_.assign(n_nodes, false);
  std::vector<NodeIndex> row;
  for (const auto& [cell, wanted] : boundary) {
    const auto nodes = cells_[cell];
    std::uint32_t position = 0;
    for_each_facet(dim_, nodes.size(), [&, wanted = wanted](std::span<const std::size_t> at) {
      if (position++ != wanted) return;
      row.clear();
      for (const std::size_t k : at) row.push_back(nodes[k]);
    });
    boundary_facets_.append(row);
    for (const NodeIndex node : row) on_boundary_[node] = true;
  }
}

void Topology::build_fixed(std::vector<FixedReasons> reasons) {
  fixed_ = std::move(reasons);
  for (NodeIndex i = 0; i < n_nodes(); ++i)
    if (!fixed_[i] && (part() == nullptr || part()->owns_node(i))) free_nodes_.push_back(i);
  cell_has_free_node_.resize(n_cells());
  parallel_for_ranges(n_cells(), grain_of_cells, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      bool has_free_node = false;
      for (const NodeIndex i : cells_[c]) has_free_node |= !fixed_[i];
      cell_has_free_node_[c] = has_free_node;
    }
  });
}

void Topology::build_blocks() {
  constexpr std::size_t nodes_a_block = 8192;  // the sums of these nodes fit the cache of one core
  blocks_.resize(std::min(std::max<std::size_t>(1, n_nodes() / nodes_a_block), n_cells()));
  parallel_for(blocks_.size(), [&](std::size_t b) {
    CellBlock block{static_cast<CellIndex>(n_cells() * b / blocks_.size()),
                    static_cast<CellIndex>(n_cells() * (b + 1) / blocks_.size()),
                    static_cast<NodeIndex>(n_nodes()), 0};
    for (CellIndex c = block.first; c < block.last; ++c)
      for (const NodeIndex node : cells_[c]) {
        block.first_node = std::min(block.first_node, node);
        block.last_node = std::max(block.last_node, node + 1);
      }
    blocks_[b] = block;
  });
}

const CompressedRows<NodeIndex>& Topology::neighbours() const {
  return node_neighbours_.get([this] { return nodes_by_node(*this, cells_by_node()); });
}

std::vector<CellIndex> Topology::cells_around(std::span<const NodeIndex> nodes) const {
  std::vector<CellIndex> cells;
  for (const NodeIndex i : nodes) {
    const auto attached = node_cells(i);
    cells.insert(cells.end(), attached.begin(), attached.end());
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

std::shared_ptr<const Topology> Topology::without_midside() const {
  std::shared_ptr<Topology> result(new Topology);
  result->dim_ = dim_;
  result->cells_ = cells_;
  result->labels_ = labels_;
  result->labels_.midside = nullptr;
  result->boundary_facets_ = boundary_facets_;
  result->n_facets_ = n_facets_;
  result->on_boundary_ = on_boundary_;
  result->fixed_ = fixed_;
  result->free_nodes_ = free_nodes_;
  result->cell_has_free_node_ = cell_has_free_node_;
  result->blocks_ = blocks_;
  return result;
}

std::shared_ptr<const Topology> Topology::reordered(
    const std::vector<NodeIndex>& node_order, const std::vector<CellIndex>& cell_order) const {
  const std::size_t n_kept = node_order.size();
  std::vector<NodeIndex> new_node(n_nodes());
  for (NodeIndex i = 0; i < n_kept; ++i) new_node[node_order[i]] = i;
  std::shared_ptr<Topology> result(new Topology);
  result->dim_ = dim_;
  std::vector<RowOffset> lengths(n_cells() + 1, 0);
  parallel_for_ranges(n_cells(), grain_of_cells, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c)
      lengths[c + 1] = static_cast<RowOffset>(cells_[cell_order[c]].size());
  });
  auto offsets = row_offsets(std::move(lengths));
  std::vector<NodeIndex> entries(offsets.back());
  parallel_for_ranges(n_cells(), grain_of_cells, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      const auto nodes = cells_[cell_order[c]];
      for (std::size_t k = 0; k < nodes.size(); ++k) entries[offsets[c] + k] = new_node[nodes[k]];
    }
  });
  result->cells_ = {std::move(offsets), std::move(entries)};
  result->n_facets_ = n_facets_;
  result->on_boundary_.resize(n_kept);
  std::vector<FixedReasons> reasons(n_kept);
  for (NodeIndex i = 0; i < n_kept; ++i) {
    result->on_boundary_[i] = on_boundary_[node_order[i]];
    reasons[i] = fixed_[node_order[i]];
  }
  std::vector<NodeIndex> row;
  for (std::size_t f = 0; f < boundary_facets_.size(); ++f) {
    row.clear();
    for (const NodeIndex node : boundary_facets_[f]) row.push_back(new_node[node]);
    result->boundary_facets_.append(row);
  }
  result->build_fixed(std::move(reasons));
  result->build_blocks();
  return result;
}

void require_linear(const Topology& topology, const std::string& what) {
  if (topology.midside())
    throw InputError(
        what +
        " is for linear cells only, but the mesh has cells of second order; save it with "
        "linear cells");
}

CompressedRows<NodeIndex> nodes_by_node(const Topology& topology,
                                        const CompressedRows<CellIndex>& node_cells) {
  const auto simplex_size = static_cast<std::size_t>(topology.dimension() + 1);
  return make_rows<NodeIndex>(topology.n_nodes(), [&](std::size_t node,
                                                      std::vector<NodeIndex>& row) {
    thread_local std::vector<std::uint8_t> marks;  // nodes of the row; all zero between two rows
    auto& is_known = marks;
    if (is_known.size() < topology.n_nodes()) is_known.resize(topology.n_nodes(), 0);
    std::size_t n = 0, n_most = 0;
    for (const CellIndex c : node_cells[node]) n_most += 2 * topology.cell_nodes(c).size();
    row.resize(n_most + 1);
    const auto add = [&](NodeIndex other) {  // no branch: its direction could not be predicted
      row[n] = other;
      n += 1u - is_known[other];
      is_known[other] = 1;
    };
    is_known[node] = 1;
    for (const CellIndex c : node_cells[node]) {
      const auto nodes = topology.cell_nodes(c);
      if (nodes.size() == simplex_size) {
        for (const NodeIndex other : nodes) add(other);
      } else {
        for_each_edge(topology.dimension(), nodes.size(), [&](std::size_t a, std::size_t b) {
          if (nodes[a] == node) add(nodes[b]);
          if (nodes[b] == node) add(nodes[a]);
        });
      }
    }
    is_known[node] = 0;
    row.resize(n);
    for (const NodeIndex other : row) is_known[other] = 0;
    std::sort(row.begin(), row.end());
  });
}

}  // namespace smoothfem
