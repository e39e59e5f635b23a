// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/distributed_mesh.h"

#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/mesh/interfaces.h"

namespace smoothfem {

namespace {

/// The part of a rank, with its exchange of copies.
class RankPart final : public MeshPart {
 public:
  /// positions: the nodes of the part in the order of the halo's entries.
  RankPart(const Ranks& ranks, std::vector<std::uint8_t> owns_node,
           std::vector<std::uint8_t> owns_cell, std::size_t n_cells_of_whole, Halo halo,
           std::vector<NodeIndex> positions)
      : MeshPart(std::move(owns_node), std::move(owns_cell), n_cells_of_whole),
        ranks_(ranks),
        halo_(std::move(halo)),
        positions_(std::move(positions)) {
    while (n_own_ < positions_.size() && this->owns_node(positions_[n_own_])) ++n_own_;
  }

  void update(std::span<double> values, std::size_t n) const override {
    Eigen::VectorXd entries(static_cast<Eigen::Index>(positions_.size()));
    for (std::size_t d = 0; d < n; ++d) {
      for (std::size_t k = 0; k < n_own_; ++k)
        entries[static_cast<Eigen::Index>(k)] = values[n * positions_[k] + d];
      halo_.update(entries);
      for (std::size_t k = n_own_; k < positions_.size(); ++k)
        values[n * positions_[k] + d] = entries[static_cast<Eigen::Index>(k)];
    }
  }
  void sum(std::span<std::int64_t> values) const override { ranks_.sum(values); }
  void min(std::span<double> values) const override { ranks_.min(values); }
  void max(std::span<double> values) const override { ranks_.max(values); }
  using MeshPart::max;
  using MeshPart::sum;

 private:
  Ranks ranks_;
  Halo halo_;
  std::vector<NodeIndex> positions_;
  std::size_t n_own_ = 0;
};

/// Returns the position of a number in an ascending list that has it.
std::size_t position_in(std::span<const GlobalIndex> list, GlobalIndex number) {
  return static_cast<std::size_t>(std::lower_bound(list.begin(), list.end(), number) -
                                  list.begin());
}

std::vector<GlobalIndex> sorted_nodes(const CompressedRows<GlobalIndex>& corners) {
  std::vector<GlobalIndex> nodes = corners.entries();
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  nodes.shrink_to_fit();
  return nodes;
}

/// The nodes of some cells, and who owns each.
struct OwnedNodes {
  std::vector<GlobalIndex> numbers;  ///< ascending
  std::vector<int> owners;

  int owner(GlobalIndex number) const { return owners[position_in(numbers, number)]; }
};

/// Chooses the owner of each node among the ranks with cells around it: the first of these.
template <int dim>
OwnedNodes choose_owners(ScatteredMesh<dim>& mesh) {
  OwnedNodes nodes{sorted_nodes(mesh.corners), {}};
  const std::vector<NodeEntry<dim>> nothing(nodes.numbers.size());
  mesh.nodes.give(nodes.numbers, nothing, [](NodeEntry<dim>& kept, const NodeEntry<dim>&, int r) {
    if (kept.owner < 0) kept.owner = r;
  });
  for (const auto& entry : mesh.nodes.ask(nodes.numbers)) nodes.owners.push_back(entry.owner);
  return nodes;
}

/// Cells of a part: those of its rank, and copies of all others around its nodes.
struct PartCells {
  std::vector<GlobalIndex> cells;  ///< ascending
  CompressedRows<GlobalIndex> corners;
  std::vector<int> tags;
  std::vector<std::uint8_t> owns_cell;
  OwnedNodes nodes;
};

/// Sends each cell to the owners of its nodes.
template <int dim>
PartCells add_copies(const Ranks& ranks, ScatteredMesh<dim>& mesh, OwnedNodes nodes) {
  // A cell: its number, tag, number of corners, corners, their owners.
  std::vector<std::vector<GlobalIndex>> sent(static_cast<std::size_t>(ranks.size()));
  std::vector<int> owners, others;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto corners = mesh.corners[c];
    owners.clear();
    for (const GlobalIndex node : corners) owners.push_back(nodes.owner(node));
    others = owners;
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    for (const int r : others) {
      if (r == ranks.rank()) continue;
      auto& words = sent[static_cast<std::size_t>(r)];
      words.insert(words.end(), {mesh.cells[c], static_cast<GlobalIndex>(mesh.tags[c]),
                                 static_cast<GlobalIndex>(corners.size())});
      words.insert(words.end(), corners.begin(), corners.end());
      words.insert(words.end(), owners.begin(), owners.end());
    }
  }
  const auto received = ranks.exchange(std::move(sent));
  struct Place {
    GlobalIndex cell;
    const GlobalIndex* words;  // null: a cell of this rank
    std::size_t own;
  };
  std::vector<Place> places;
  places.reserve(mesh.cells.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) places.push_back({mesh.cells[c], nullptr, c});
  std::vector<std::pair<GlobalIndex, int>> further;  // nodes of copied cells
  for (const auto& words : received)
    for (std::size_t at = 0; at < words.size(); at += 3 + 2 * words[at + 2]) {
      places.push_back({words[at], &words[at], 0});
      for (std::size_t k = 0; k < words[at + 2]; ++k)
        further.emplace_back(words[at + 3 + k],
                             static_cast<int>(words[at + 3 + words[at + 2] + k]));
    }
  std::sort(places.begin(), places.end(),
            [](const Place& a, const Place& b) { return a.cell < b.cell; });
  PartCells part;
  for (const Place& place : places) {
    part.cells.push_back(place.cell);
    part.owns_cell.push_back(place.words == nullptr);
    if (place.words == nullptr) {
      part.corners.append(mesh.corners[place.own]);
      part.tags.push_back(mesh.tags[place.own]);
    } else {
      part.corners.append(std::span(place.words + 3, place.words[2]));
      part.tags.push_back(static_cast<int>(place.words[1]));
    }
  }
  for (std::size_t i = 0; i < nodes.numbers.size(); ++i)
    further.emplace_back(nodes.numbers[i], nodes.owners[i]);
  std::sort(further.begin(), further.end());
  further.erase(std::unique(further.begin(), further.end()), further.end());
  for (const auto& [number, owner] : further) {
    part.nodes.numbers.push_back(number);
    part.nodes.owners.push_back(owner);
  }
  return part;
}

/// Returns the part's exchange: own nodes are numbered rank by rank.
std::shared_ptr<const MeshPart> make_rank_part(const Ranks& ranks, const OwnedNodes& nodes,
                                               std::vector<std::uint8_t> owns_cell,
                                               std::size_t n_cells_of_whole,
                                               std::size_t& n_nodes_of_whole) {
  std::vector<std::uint8_t> owns_node;
  std::vector<GlobalIndex> own;
  std::vector<NodeIndex> positions, copies;
  std::vector<std::vector<GlobalIndex>> asked(static_cast<std::size_t>(ranks.size()));
  for (NodeIndex i = 0; i < nodes.numbers.size(); ++i) {
    owns_node.push_back(nodes.owners[i] == ranks.rank());
    if (owns_node.back()) {
      own.push_back(nodes.numbers[i]);
      positions.push_back(i);
    } else {
      asked[static_cast<std::size_t>(nodes.owners[i])].push_back(nodes.numbers[i]);
      copies.push_back(i);
    }
  }
  const std::size_t first = ranks.exclusive_scan(own.size());
  n_nodes_of_whole = ranks.sum(own.size());
  const auto questions = ranks.exchange(std::move(asked));
  std::vector<std::vector<std::size_t>> answers(questions.size());
  for (std::size_t r = 0; r < questions.size(); ++r)
    for (const GlobalIndex number : questions[r])
      answers[r].push_back(first + position_in(own, number));
  const auto numbers = ranks.exchange(std::move(answers));
  // Copies of one owner are asked for in ascending order, and so are their numbers.
  std::stable_sort(copies.begin(), copies.end(),
                   [&](NodeIndex a, NodeIndex b) { return nodes.owners[a] < nodes.owners[b]; });
  positions.insert(positions.end(), copies.begin(), copies.end());
  std::vector<std::size_t> ghosts;
  for (const auto& of_rank : numbers) ghosts.insert(ghosts.end(), of_rank.begin(), of_rank.end());
  return std::make_shared<RankPart>(
      ranks, std::move(owns_node), std::move(owns_cell), n_cells_of_whole,
      Halo(ranks, n_nodes_of_whole, first, own.size(), ghosts), std::move(positions));
}

/// Gives copied nodes the reasons that their owners have found.
void update_reasons(const MeshPart& part, std::vector<FixedReasons>& reasons) {
  std::vector<double> values(reasons.begin(), reasons.end());
  part.update(values, 1);
  std::transform(values.begin(), values.end(), reasons.begin(),
                 [](double value) { return static_cast<FixedReasons>(value); });
}

/// The cells of a part with its own numbers of nodes, and why its own nodes stay.
struct LocalCells {
  CompressedRows<NodeIndex> rows;
  MeshLabels labels;
  std::vector<FixedReasons> reasons;
};

/// Boundary and interfaces are known where all cells around a node are: at its owner.
template <int dim>
LocalCells make_local_cells(PartCells cells, const std::vector<NodeEntry<dim>>& entries,
                            bool fixes_boundary) {
  LocalCells local;
  auto& [rows, labels, reasons] = local;
  const std::size_t n_nodes = cells.nodes.numbers.size();
  {
    std::vector<RowOffset> offsets{0};
    std::vector<NodeIndex> nodes;
    nodes.reserve(cells.corners.n_entries());
    for (const GlobalIndex number : cells.corners.entries())
      nodes.push_back(static_cast<NodeIndex>(position_in(cells.nodes.numbers, number)));
    for (std::size_t c = 0; c < cells.corners.size(); ++c)
      offsets.push_back(static_cast<RowOffset>(cells.corners.offset(c) + cells.corners[c].size()));
    rows = {std::move(offsets), std::move(nodes)};
  }
  cells.corners = {};
  const bool any_tag = std::any_of(cells.tags.begin(), cells.tags.end(),
                                   [&](int tag) { return tag != cells.tags.front(); });
  if (any_tag) labels.cell_tags = cells.tags;
  const Topology alone(dim, n_nodes, rows, std::nullopt, labels);
  const auto interface = interface_nodes(alone);
  for (NodeIndex i = 0; i < n_nodes; ++i) {
    // Labelled elements set their nodes apart inside the mesh only.
    FixedReasons of_node = entries[i].reasons;
    if (alone.on_boundary()[i]) of_node &= static_cast<FixedReasons>(~bit(FixedReason::interface));
    if (fixes_boundary && alone.on_boundary()[i]) of_node |= bit(FixedReason::boundary);
    if (!interface.empty() && interface[i]) of_node |= bit(FixedReason::interface);
    reasons.push_back(of_node);
  }
  return local;
}

}  // namespace

template <int dim>
DistributedMesh<dim> distribute(const Ranks& ranks, ScatteredMesh<dim> mesh) {
  OwnedNodes nodes = choose_owners(mesh);
  PartCells cells = add_copies(ranks, mesh, std::move(nodes));
  mesh.cells = {};
  mesh.corners = {};
  mesh.tags = {};
  const auto entries = mesh.nodes.ask(cells.nodes.numbers);
  std::size_t n_nodes = 0;
  auto part = make_rank_part(ranks, cells.nodes, std::move(cells.owns_cell), mesh.n_cells, n_nodes);
  auto numbers = cells.nodes.numbers;
  LocalCells local;
  ranks.together(
      [&] { local = make_local_cells<dim>(std::move(cells), entries, mesh.fixes_boundary); });
  update_reasons(*part, local.reasons);
  local.labels.part = std::move(part);
  std::vector<Point<dim>> points;
  points.reserve(entries.size());
  for (const auto& entry : entries) points.push_back(entry.point());
  auto topology = std::make_shared<const Topology>(
      dim, points.size(), std::move(local.rows), std::move(local.reasons), std::move(local.labels));
  return {Mesh<dim>(std::move(topology), std::move(points)), std::move(numbers), n_nodes,
          std::move(mesh.nodes)};
}

template <int dim>
void store_coordinates(DistributedMesh<dim>& mesh) {
  const Topology& topology = mesh.part.topology();
  std::vector<GlobalIndex> numbers;
  std::vector<NodeEntry<dim>> entries;
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
    if (topology.part()->owns_node(i)) {
      numbers.push_back(mesh.nodes[i]);
      entries.push_back(
          node_entry<dim>(std::as_const(mesh.part).coordinates()[i], topology.fixed_reasons(i)));
    }
  mesh.directory.give(numbers, entries, [](NodeEntry<dim>& kept, const NodeEntry<dim>& given, int) {
    kept.x = given.x;
    kept.reasons = given.reasons;
  });
}

template DistributedMesh<2> distribute(const Ranks&, ScatteredMesh<2>);
template DistributedMesh<3> distribute(const Ranks&, ScatteredMesh<3>);
template void store_coordinates(DistributedMesh<2>&);
template void store_coordinates(DistributedMesh<3>&);

}  // namespace smoothfem
