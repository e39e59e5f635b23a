// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/space/nodal_dofs.h"

#include <algorithm>
#include <bit>

#include "fem/materials/cell_kinds.h"
#include "smoothing/parts/mesh_part.h"

namespace smoothfem {

namespace {

using Numbers = std::vector<std::uint32_t>;

std::vector<NodeIndex> ascending(std::span<const NodeIndex> nodes) {
  std::vector<NodeIndex> sorted(nodes.begin(), nodes.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

constexpr auto absent = FiniteElementSpace<3>::absent;
/// Status of a node on a rank: owned by another rank, own, or used by no cell.
constexpr std::uint32_t other = 0, own = 1, unused = 2;

/// Returns the cells level by level around the first one, so that neighbours are close to each
/// other.
std::vector<CellIndex> breadth_first_cells(const Topology& topology) {
  std::vector<CellIndex> order;
  std::vector<bool> seen(topology.n_cells(), false);
  const auto take = [&](CellIndex cell) {
    if (!seen[cell]) order.push_back(cell);
    seen[cell] = true;
  };
  std::size_t next = 0;
  for (CellIndex start = 0; start < topology.n_cells(); ++start)
    for (take(start); next < order.size(); ++next)
      for (const NodeIndex node : topology.cell_nodes(order[next]))
        for (const CellIndex neighbour : topology.node_cells(node)) take(neighbour);
  return order;
}

/// Messages of the root to each rank: numbers of nodes in the mesh and of free dofs, and the cells.
class PartDistributor {
 public:
  PartDistributor(const Topology& topology, const NaturalBoundary& natural, const NodeTies* ties,
                  std::size_t n_ranks)
      : topology_(topology),
        n_ranks_(n_ranks),
        order_(breadth_first_cells(topology)),
        kinds_(cell_kinds(topology)) {
    static const NodeTies none;
    tie_.assign(topology.n_nodes(), nullptr);
    for (const NodeTie& tie : (ties == nullptr ? none : *ties).nodes) tie_[tie.node] = &tie;
    find_owners();
    number_free_nodes(natural, (ties == nullptr ? none : *ties).inner_facets);
  }

  /// Returns the message for a rank. First the first number of a free dof, and the numbers of
  /// nodes, of own cells, of cells and of tied nodes. Then for each node its number in the mesh,
  /// its status on the rank, and its number among all free dofs or `absent`. Then for each cell its
  /// kind, its number in the mesh and the number of its nodes, followed by these; the rank's own
  /// cells come first. Then for each tied node its number here and that of its masters, followed by
  /// their numbers here and weights. A single rank has all nodes, with their numbers.
  Numbers of_rank(std::size_t rank) const {
    std::vector<CellIndex> cells;
    for (std::size_t k = first_cell(rank); k < first_cell(rank + 1); ++k)
      cells.push_back(order_[k]);
    const std::size_t n_own_cells = cells.size();
    for (std::size_t k = 0; n_ranks_ > 1 && k < order_.size(); ++k)
      if ((k < first_cell(rank) || k >= first_cell(rank + 1)) && contributes(order_[k], rank))
        cells.push_back(order_[k]);
    Numbers of_nodes, of_cells, local(topology_.n_nodes(), absent);
    std::uint32_t n_nodes = 0;
    const auto add_node = [&](NodeIndex node) {
      local[node] = n_nodes++;
      const std::uint32_t had = owner_[node] == absent ? unused
                                : owner_[node] == rank ? own
                                                       : other;
      of_nodes.insert(of_nodes.end(), {node, had, number_[node]});
    };
    for (NodeIndex node = 0; n_ranks_ == 1 && node < topology_.n_nodes(); ++node) add_node(node);
    for (const CellIndex cell : cells) {
      const auto nodes = topology_.cell_nodes(cell);
      of_cells.push_back(kinds_[cell]);
      of_cells.push_back(cell);
      of_cells.push_back(static_cast<std::uint32_t>(nodes.size()));
      for (const NodeIndex node : nodes) {
        if (local[node] == absent) add_node(node);
        of_cells.push_back(local[node]);
      }
    }
    Numbers of_ties;
    std::uint32_t n_ties = 0;
    for (NodeIndex node = 0; node < topology_.n_nodes(); ++node) {
      if (tie_[node] == nullptr || local[node] == absent) continue;
      ++n_ties;
      of_ties.insert(of_ties.end(),
                     {local[node], static_cast<std::uint32_t>(tie_[node]->masters.size())});
      for (const auto& [master, weight] : tie_[node]->masters) {
        if (local[master] == absent) add_node(master);
        const auto bits = std::bit_cast<std::uint64_t>(weight);
        of_ties.insert(of_ties.end(), {local[master], static_cast<std::uint32_t>(bits >> 32U),
                                       static_cast<std::uint32_t>(bits)});
      }
    }
    Numbers message{first_number_[rank], n_nodes, static_cast<std::uint32_t>(n_own_cells),
                    static_cast<std::uint32_t>(cells.size()), n_ties};
    for (const Numbers* part : {&of_nodes, &of_cells, &of_ties})
      message.insert(message.end(), part->begin(), part->end());
    return message;
  }

 private:
  std::size_t first_cell(std::size_t rank) const { return rank * order_.size() / n_ranks_; }

  /// True if a cell of another rank contributes to an equation here.
  bool contributes(CellIndex cell, std::size_t rank) const {
    const auto nodes = topology_.cell_nodes(cell);
    return std::any_of(nodes.begin(), nodes.end(), [&](NodeIndex node) {
      if (tie_[node] == nullptr) return owner_[node] == rank;
      const auto& masters = tie_[node]->masters;
      return std::any_of(masters.begin(), masters.end(),
                         [&](const auto& master) { return owner_[master.first] == rank; });
    });
  }

  /// Finds the owner of each node: the first rank that has a cell with it.
  void find_owners() {
    owner_.assign(topology_.n_nodes(), absent);
    for (std::uint32_t rank = 0; rank < n_ranks_; ++rank)
      for (std::size_t k = first_cell(rank); k < first_cell(rank + 1); ++k)
        for (const NodeIndex node : topology_.cell_nodes(order_[k]))
          owner_[node] = std::min(owner_[node], rank);
  }

  /// Numbers free nodes rank by rank, in the order of the rank's cells.
  void number_free_nodes(const NaturalBoundary& natural,
                         const std::set<std::vector<NodeIndex>>& inner_facets) {
    std::vector<bool> taken(topology_.n_nodes(), false);  // on the boundary, or numbered
    for (std::size_t f = 0; f < topology_.boundary_facets().size(); ++f) {
      const auto facet = topology_.boundary_facets()[f];
      if (!inner_facets.empty() && inner_facets.contains(ascending(facet))) continue;
      if (natural.empty() || !natural.contains({facet.begin(), facet.end()}))
        for (const NodeIndex node : facet) taken[node] = true;
    }
    // Boundary values of a node hold for its partner, too.
    for (const NodeTie* tie : tie_)
      if (tie != nullptr) {
        if (tie->masters.size() == 1 && taken[tie->node]) taken[tie->masters.front().first] = true;
        taken[tie->node] = true;
      }
    number_.assign(topology_.n_nodes(), absent);
    std::uint32_t next = 0;
    for (std::size_t rank = 0; rank < n_ranks_; ++rank) {
      first_number_.push_back(next);
      for (std::size_t k = first_cell(rank); k < first_cell(rank + 1); ++k)
        for (const NodeIndex node : topology_.cell_nodes(order_[k])) {
          if (taken[node] || owner_[node] != rank) continue;
          taken[node] = true;
          number_[node] = next++;
        }
    }
  }

  const Topology& topology_;
  const std::size_t n_ranks_;
  const std::vector<CellIndex> order_;
  const Numbers kinds_;
  Numbers owner_, number_, first_number_;
  std::vector<const NodeTie*> tie_;  ///< of each node; null: none
};

Numbers message_of_root(const Topology* topology, const NaturalBoundary& natural,
                        const NodeTies* ties, const Ranks& ranks) {
  std::vector<std::size_t> lengths;
  Numbers all;
  if (topology != nullptr) {
    const auto n_ranks = static_cast<std::size_t>(ranks.size());
    const PartDistributor distributor(*topology, natural, ties, n_ranks);
    for (std::size_t rank = 0; rank < n_ranks; ++rank) {
      const Numbers message = distributor.of_rank(rank);
      lengths.push_back(message.size());
      all.insert(all.end(), message.begin(), message.end());
    }
  }
  return ranks.scatter(all, ranks.scatter(lengths, 1).front());
}

/// Returns the same message for the part of a mesh that a rank already has. Owners of nodes know
/// the boundary, because they have all cells around these. Collective.
Numbers message_of_part(const Topology& topology, const Ranks& ranks) {
  const MeshPart& part = *topology.part();
  constexpr double boundary = -1.0;
  std::vector<double> numbers(topology.n_nodes(), boundary);
  const auto is_own_free = [&](NodeIndex node) {
    return part.owns_node(node) && !topology.on_boundary()[node];
  };
  std::size_t n_free = 0;
  for (NodeIndex node = 0; node < topology.n_nodes(); ++node) n_free += is_own_free(node);
  const std::size_t first = ranks.exclusive_scan(n_free);
  std::size_t next = first;
  for (NodeIndex node = 0; node < topology.n_nodes(); ++node)
    if (is_own_free(node)) numbers[node] = static_cast<double>(next++);
  part.update(numbers, 1);

  const auto n_nodes = static_cast<std::uint32_t>(topology.n_nodes()),
             n_cells = static_cast<std::uint32_t>(topology.n_cells());
  Numbers message{static_cast<std::uint32_t>(first), n_nodes, 0, n_cells, 0};
  message.reserve(message.size() + 3 * (std::size_t{n_nodes} + n_cells) +
                  topology.cells().n_entries());
  for (NodeIndex node = 0; node < n_nodes; ++node)
    message.insert(
        message.end(),
        {node, part.owns_node(node) ? own : other,
         numbers[node] == boundary ? absent : static_cast<std::uint32_t>(numbers[node])});
  for (const bool is_own : {true, false})
    for (CellIndex cell = 0; cell < n_cells; ++cell) {
      if (part.owns_cell(cell) != is_own) continue;
      message[2] += is_own;
      const auto nodes = topology.cell_nodes(cell);
      message.insert(message.end(), {0, cell, static_cast<std::uint32_t>(nodes.size())});
      message.insert(message.end(), nodes.begin(), nodes.end());
    }
  return message;
}

/// Fills a space from the root's message.
template <int dim>
class SpaceFiller {
 public:
  SpaceFiller(const Numbers& message, FiniteElementSpace<dim>& space)
      : first_number_(message[0]),
        n_nodes_(message[1]),
        n_own_cells_(message[2]),
        n_cells_(message[3]),
        n_ties_(message[4]),
        of_nodes_(message.data() + 5),
        of_cells_(of_nodes_ + 3 * n_nodes_),
        space_(space) {}

  void number_dofs() {
    find_tied_nodes();
    std::size_t n_own_dofs = 0, n_own_tied = 0;
    Numbers ghosts;
    for (std::size_t i = 0; i < n_nodes_; ++i) {
      space_.nodes.push_back(of_nodes_[3 * i]);
      n_own_dofs += is_own(i);
      n_own_tied += is_own(i) && is_tied_[i];
      if (number(i) == absent) continue;
      space_.n_own += is_own(i);
      if (!is_own(i)) ghosts.push_back(number(i));
    }
    std::sort(ghosts.begin(), ghosts.end());
    space_.n_own_boundary = n_own_dofs - space_.n_own - n_own_tied;
    space_.n_columns = space_.n_own + ghosts.size();
    space_.n_dofs = space_.ranks.sum(n_own_dofs);
    space_.n_free = space_.ranks.sum(space_.n_own);
    for (std::size_t i = 0; i < space_.n_own; ++i)
      space_.column_numbers.push_back(first_number_ + i);
    space_.column_numbers.insert(space_.column_numbers.end(), ghosts.begin(), ghosts.end());
    space_.halo = Halo(space_.ranks, space_.n_free, first_number_, space_.n_own,
                       {ghosts.begin(), ghosts.end()});
    number_local_dofs(ghosts);
    read_ties();
    space_.vertex_dof = dof_of_node_;
  }

  void add_cells(const TensorPoints& tensor_points) {
    reserve_cells(tensor_points);
    const std::uint32_t* next = of_cells_;
    for (std::size_t c = 0; c < n_cells_; ++c) {
      const std::uint32_t kind = *next++;
      const CellIndex number = *next++;
      std::vector<NodeIndex> nodes(next + 1, next + 1 + *next);
      next += 1 + *next;
      auto& group = group_of(element_type(dim, nodes.size()), tensor_points);
      const ElementType type = group.element.type;
      if (type == ElementType::pyramid || type == ElementType::hexahedron ||
          type == ElementType::quadrilateral)
        // Deal.II's quadrilaterals: lexicographic.
        for (std::size_t k = 2; k + 1 < nodes.size(); k += 4) std::swap(nodes[k], nodes[k + 1]);
      group.n_own += c < n_own_cells_;
      group.kinds.push_back(kind);
      group.numbers.push_back(number);
      for (const NodeIndex node : nodes) group.dofs.push_back(dof_of_node_[node]);
      group.vertices.insert(group.vertices.end(), nodes.begin(), nodes.end());
    }
  }

 private:
  bool is_own(std::size_t i) const { return of_nodes_[3 * i + 1] == own; }
  bool is_unused(std::size_t i) const { return of_nodes_[3 * i + 1] == unused; }
  std::uint32_t number(std::size_t i) const { return of_nodes_[3 * i + 2]; }

  /// Returns the position of the ties in the message.
  const std::uint32_t* ties() const {
    const std::uint32_t* next = of_cells_;
    for (std::size_t c = 0; c < n_cells_; ++c) next += 3 + next[2];
    return next;
  }

  void find_tied_nodes() {
    is_tied_.assign(n_nodes_, false);
    const std::uint32_t* next = ties();
    for (std::size_t t = 0; t < n_ties_; ++t, next += 2 + 3 * next[1]) is_tied_[next[0]] = true;
  }

  void read_ties() {
    space_.ties.resize(n_ties_);
    const std::uint32_t* next = ties();
    for (std::size_t t = 0; t < n_ties_; ++t) {
      auto& masters = space_.ties[dof_of_node_[next[0]] - (space_.n_local - n_ties_)];
      const std::uint32_t n_masters = next[1];
      next += 2;
      for (std::uint32_t m = 0; m < n_masters; ++m, next += 3)
        masters.emplace_back(dof_of_node_[next[0]],
                             std::bit_cast<double>(std::uint64_t{next[1]} << 32U | next[2]));
    }
  }

  /// Numbers own free dofs first, then those of others, then boundary dofs with own ones first,
  /// then tied ones.
  void number_local_dofs(const Numbers& ghosts) {
    std::size_t next_own = space_.n_columns, next_other = next_own + space_.n_own_boundary;
    std::size_t n_boundary = 0;
    for (std::size_t i = 0; i < n_nodes_; ++i)
      n_boundary += number(i) == absent && !is_unused(i) && !is_tied_[i];
    std::size_t next_tied = space_.n_columns + n_boundary;
    for (std::size_t i = 0; i < n_nodes_; ++i) {
      std::size_t dof = absent;
      if (is_tied_[i])
        dof = next_tied++;
      else if (number(i) != absent && is_own(i))
        dof = number(i) - first_number_;
      else if (number(i) != absent)
        dof = space_.n_own +
              static_cast<std::size_t>(std::lower_bound(ghosts.begin(), ghosts.end(), number(i)) -
                                       ghosts.begin());
      else if (!is_unused(i))
        dof = is_own(i) ? next_own++ : next_other++;
      dof_of_node_.push_back(static_cast<std::uint32_t>(dof));
    }
    space_.n_local = next_tied;
  }

  /// Reserves memory of exactly the size that the cells need.
  void reserve_cells(const TensorPoints& tensor_points) {
    std::vector<std::pair<std::size_t, std::size_t>> counts;  // of nodes, and cells with as many
    const std::uint32_t* next = of_cells_;
    for (std::size_t c = 0; c < n_cells_; ++c, next += 3 + next[2]) {
      auto count = counts.begin();
      while (count != counts.end() && count->first != next[2]) ++count;
      if (count == counts.end()) count = counts.insert(count, {next[2], 0});
      ++count->second;
    }
    for (const auto& [n_nodes, n] : counts) {
      auto& group = group_of(element_type(dim, n_nodes), tensor_points);
      group.kinds.reserve(n);
      group.numbers.reserve(n);
      group.dofs.reserve(n * n_nodes);
      group.vertices.reserve(n * n_nodes);
    }
  }

  ElementCells& group_of(ElementType type, const TensorPoints& tensor_points) {
    for (auto& group : space_.groups)
      if (group.element.type == type) return group;
    auto& group = space_.groups.emplace_back();
    group.element = make_reference_element(
        type, 1, dim == 2 ? tensor_points.quadrilateral : tensor_points.hexahedron,
        space_.is_curved);
    return group;
  }

  const std::uint32_t first_number_;
  const std::size_t n_nodes_, n_own_cells_, n_cells_, n_ties_;
  const std::uint32_t* const of_nodes_;
  const std::uint32_t* const of_cells_;
  FiniteElementSpace<dim>& space_;
  Numbers dof_of_node_;
  std::vector<bool> is_tied_;
};

}  // namespace

template <int dim>
void number_nodal_dofs(const Topology* topology, const TensorPoints& tensor_points,
                       const NaturalBoundary& natural, const NodeTies* ties,
                       FiniteElementSpace<dim>& space) {
  const Numbers message = space.in_parts ? message_of_part(*topology, space.ranks)
                                         : message_of_root(topology, natural, ties, space.ranks);
  SpaceFiller<dim> filler(message, space);
  filler.number_dofs();
  filler.add_cells(tensor_points);
}
template void number_nodal_dofs(const Topology*, const TensorPoints&, const NaturalBoundary&,
                                const NodeTies*, FiniteElementSpace<2>&);
template void number_nodal_dofs(const Topology*, const TensorPoints&, const NaturalBoundary&,
                                const NodeTies*, FiniteElementSpace<3>&);

}  // namespace smoothfem
