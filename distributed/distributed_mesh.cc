// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/distributed_mesh.h"

#include <optional>

#include "smoothing/base/parallel.h"
#include "smoothing/mesh/interfaces.h"

namespace smoothfem {

namespace {

/// Exchange between owners and copies of the nodes or of the cells of a part.
class CopyExchange {
 public:
  /// numbers: in the whole mesh, ascending. owners: the rank that owns each. Collective.
  CopyExchange(const Ranks& ranks, std::span<const GlobalIndex> numbers,
               std::span<const int> owners);

  /// Returns the number of owned ones of the whole mesh.
  std::size_t n_of_whole() const { return n_of_whole_; }

  void update(std::span<double> values, std::size_t n) const {
    for (std::size_t d = 0; d < n; ++d) {
      auto entries = own_entries(values, n, d);
      halo_.update(entries);
      take(entries, n_own_, values, n, d);
    }
  }
  /// Replaces each value by the sum over its copies.
  void sum(std::span<double> values) const {
    auto entries = own_entries(values, 1, 0);
    for (std::size_t k = n_own_; k < positions_.size(); ++k)
      entries[static_cast<Eigen::Index>(k)] = values[positions_[k]];
    halo_.add_to_owners(entries);
    halo_.update(entries);
    take(entries, 0, values, 1, 0);
  }

 private:
  Eigen::VectorXd own_entries(std::span<const double> values, std::size_t n, std::size_t d) const {
    Eigen::VectorXd entries(static_cast<Eigen::Index>(positions_.size()));
    for (std::size_t k = 0; k < n_own_; ++k)
      entries[static_cast<Eigen::Index>(k)] = values[n * positions_[k] + d];
    return entries;
  }
  void take(const Eigen::VectorXd& entries, std::size_t first, std::span<double> values,
            std::size_t n, std::size_t d) const {
    for (std::size_t k = first; k < positions_.size(); ++k)
      values[n * positions_[k] + d] = entries[static_cast<Eigen::Index>(k)];
  }

  Halo halo_;
  std::vector<std::uint32_t> positions_;  ///< own ones, then copies, in the order of the halo
  std::size_t n_own_ = 0, n_of_whole_ = 0;
};

CopyExchange::CopyExchange(const Ranks& ranks, std::span<const GlobalIndex> numbers,
                           std::span<const int> owners) {
  std::vector<GlobalIndex> own;
  std::vector<std::uint32_t> copies;
  std::vector<std::vector<GlobalIndex>> asked(static_cast<std::size_t>(ranks.size()));
  for (std::uint32_t i = 0; i < numbers.size(); ++i) {
    if (owners[i] == ranks.rank()) {
      own.push_back(numbers[i]);
      positions_.push_back(i);
    } else {
      asked[static_cast<std::size_t>(owners[i])].push_back(numbers[i]);
      copies.push_back(i);
    }
  }
  n_own_ = own.size();
  const std::size_t first = ranks.exclusive_scan(n_own_);
  n_of_whole_ = ranks.sum(n_own_);
  const auto questions = ranks.exchange(std::move(asked));
  std::vector<std::vector<std::size_t>> answers(questions.size());
  for (std::size_t r = 0; r < questions.size(); ++r)
    for (const GlobalIndex number : questions[r])
      answers[r].push_back(
          first +
          static_cast<std::size_t>(std::lower_bound(own.begin(), own.end(), number) - own.begin()));
  const auto places = ranks.exchange(std::move(answers));
  // Copies of one owner are asked for in ascending order, and so are their numbers.
  std::stable_sort(copies.begin(), copies.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return owners[a] < owners[b]; });
  positions_.insert(positions_.end(), copies.begin(), copies.end());
  std::vector<std::size_t> ghosts;
  for (const auto& of_rank : places) ghosts.insert(ghosts.end(), of_rank.begin(), of_rank.end());
  halo_ = Halo(ranks, n_of_whole_, first, n_own_, ghosts);
}

/// The part of a rank.
class RankPart final : public MeshPart {
 public:
  /// node_owners: the rank that owns each node. owners_of_copies: the rank that owns each cell that
  /// this one does not own. Collective.
  RankPart(const Ranks& ranks, std::vector<GlobalIndex> nodes, std::span<const int> node_owners,
           std::vector<GlobalIndex> cells, std::vector<std::uint8_t> owns_cell,
           std::vector<int> owners_of_copies, std::size_t n_cells_of_whole)
      : MeshPart(std::move(nodes), are_own(ranks, node_owners), std::move(cells),
                 std::move(owns_cell), n_cells_of_whole),
        ranks_(ranks),
        node_exchange_(ranks, this->nodes(), node_owners),
        owners_of_copies_(std::move(owners_of_copies)) {}

  std::size_t n_nodes_of_whole() const { return node_exchange_.n_of_whole(); }

  void update(std::span<double> values, std::size_t n) const override {
    node_exchange_.update(values, n);
  }
  void sum_copies_of_cells(std::span<double> values) const override {
    if (!cell_exchange_) {
      std::vector<int> owners;
      auto owner_of_copy = owners_of_copies_.begin();
      for (CellIndex c = 0; c < cells().size(); ++c)
        owners.push_back(owns_cell(c) ? ranks_.rank() : *owner_of_copy++);
      cell_exchange_.emplace(ranks_, cells(), owners);
    }
    cell_exchange_->sum(values);
  }
  void sum(std::span<std::int64_t> values) const override { ranks_.sum(values); }
  void min(std::span<double> values) const override { ranks_.min(values); }
  void max(std::span<double> values) const override { ranks_.max(values); }
  void keep_lowest(std::span<KeyedCell> cells) const override { ranks_.keep_lowest(cells); }
  using MeshPart::max;
  using MeshPart::sum;

 private:
  static std::vector<std::uint8_t> are_own(const Ranks& ranks, std::span<const int> owners) {
    std::vector<std::uint8_t> flags;
    flags.reserve(owners.size());
    for (const int owner : owners) flags.push_back(owner == ranks.rank());
    return flags;
  }
  std::vector<std::byte> gather_bytes(std::span<const std::byte> bytes) const override {
    return ranks_.gather_all_bytes(bytes);
  }

  Ranks ranks_;
  CopyExchange node_exchange_;
  std::vector<int> owners_of_copies_;
  mutable std::optional<CopyExchange> cell_exchange_;  ///< few methods need it
};

/// The nodes of some cells, and who owns each.
struct OwnedNodes {
  NumberSet numbers;
  std::vector<int> owners{};  ///< in the order of the numbers

  int owner(GlobalIndex number) const { return owners[numbers.position(number)]; }
};

/// Chooses the owner of each node among the ranks with cells around it: the first of these.
template <int dim>
OwnedNodes choose_owners(ScatteredMesh<dim>& mesh) {
  OwnedNodes nodes{NumberSet(mesh.nodes.n())};
  for (const GlobalIndex number : mesh.cells.corners) nodes.numbers.add(number);
  nodes.numbers.count();
  const auto numbers = nodes.numbers.numbers();
  mesh.nodes.name(numbers, [](NodeEntry<dim>& kept, int r) {
    if (kept.owner < 0) kept.owner = r;
  });
  nodes.owners = mesh.nodes.ask(numbers, [](const NodeEntry<dim>& entry) { return entry.owner; });
  return nodes;
}

struct CellsOfPart {
  OwnedNodes nodes;
  std::vector<std::uint8_t> owns_cell{};
  std::vector<int> owners_of_copies{};  ///< in the order of the copied cells
};

/// Sends each cell to the owners of its nodes, and merges the cells from others into the table.
CellsOfPart add_copies(const Ranks& ranks, CellTable& cells, const OwnedNodes& nodes) {
  // The owners of a cell's corners follow its words.
  std::vector<std::vector<GlobalIndex>> sent(static_cast<std::size_t>(ranks.size()));
  std::vector<int> owners, others;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    owners.clear();
    for (const GlobalIndex node : cells[c]) owners.push_back(nodes.owner(node));
    others = owners;
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    for (const int r : others) {
      if (r == ranks.rank()) continue;
      auto& words = sent[static_cast<std::size_t>(r)];
      append_words(cells, c, words);
      words.insert(words.end(), owners.begin(), owners.end());
    }
  }
  const auto received = ranks.exchange(std::move(sent));
  OwnedNodes all{nodes.numbers};
  const auto for_each_copied = [&](const auto& visit) {
    for (const auto& words : received)
      for (std::size_t at = 0; at < words.size(); at += 3 + 2 * words[at + 2])
        for (std::size_t k = at + 3; k < at + 3 + words[at + 2]; ++k)
          visit(words[k], static_cast<int>(words[k + words[at + 2]]));
  };
  for_each_copied([&](GlobalIndex number, int) { all.numbers.add(number); });
  all.numbers.count();
  all.owners.resize(all.numbers.size());
  const auto before = nodes.numbers.numbers();
  for (std::size_t i = 0; i < before.size(); ++i)
    all.owners[all.numbers.position(before[i])] = nodes.owners[i];
  for_each_copied(
      [&](GlobalIndex number, int owner) { all.owners[all.numbers.position(number)] = owner; });
  std::vector<std::pair<GlobalIndex, int>> copies;
  for (std::size_t r = 0; r < received.size(); ++r)
    for (std::size_t at = 0; at < received[r].size(); at += 3 + 2 * received[r][at + 2])
      copies.emplace_back(received[r][at], static_cast<int>(r));
  std::sort(copies.begin(), copies.end());
  CellsOfPart result{std::move(all)};
  for (const auto& [number, owner] : copies) result.owners_of_copies.push_back(owner);
  result.owns_cell = merge_into(cells, sorted_cells(received, 1));
  return result;
}

/// Returns why each node of a part stays. Boundary and interfaces are known where all cells around
/// a node are: at its owner. Collective.
std::vector<FixedReasons> reasons_in_part(const Topology& topology,
                                          std::vector<FixedReasons> reasons, bool fixes_boundary) {
  const auto interface = interface_nodes(topology);
  for (NodeIndex i = 0; i < reasons.size(); ++i) {
    // Labelled elements set their nodes apart inside the mesh only.
    if (topology.on_boundary()[i])
      reasons[i] &= static_cast<FixedReasons>(~bit(FixedReason::interface));
    if (fixes_boundary && topology.on_boundary()[i]) reasons[i] |= bit(FixedReason::boundary);
    if (!interface.empty() && interface[i]) reasons[i] |= bit(FixedReason::interface);
  }
  std::vector<double> values(reasons.begin(), reasons.end());
  topology.part()->update(values, 1);
  std::transform(values.begin(), values.end(), reasons.begin(),
                 [](double value) { return static_cast<FixedReasons>(value); });
  return reasons;
}

/// Makes the topology of a part on all ranks, or throws on all. Collective.
std::shared_ptr<const Topology> make_topology(const Ranks& ranks, int dim, std::size_t n_nodes,
                                              CompressedRows<NodeIndex> cells, MeshLabels labels,
                                              std::vector<FixedReasons> reasons,
                                              bool fixes_boundary) {
  struct OtherRankFailed {};
  std::shared_ptr<const Topology> topology;
  ranks.together([&] {
    bool is_agreed = false;
    try {
      topology = std::make_shared<const Topology>(
          dim, n_nodes, std::move(cells), std::move(labels), [&](const Topology& with_boundary) {
            is_agreed = true;
            if (ranks.any(false)) throw OtherRankFailed{};
            return reasons_in_part(with_boundary, std::move(reasons), fixes_boundary);
          });
    } catch (const InputError& error) {
      if (!is_agreed) (void)ranks.any(true);
      throw InputError(
          std::string(error.what()) +
          " (numbers within a part of the mesh; 'smoothfem check' names those of the file)");
    } catch (const OtherRankFailed&) {  // its error is thrown on all
    }
  });
  return topology;
}

/// Turns the corners' numbers in the whole mesh into those of the part, in their memory.
CompressedRows<NodeIndex> local_rows(CellTable& cells, const NumberSet& numbers) {
  static_assert(std::is_same_v<GlobalIndex, NodeIndex>);
  parallel_for_ranges(cells.corners.size(), 65536, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k)
      cells.corners[k] = numbers.position(cells.corners[k]);
  });
  return {std::move(cells.offsets), std::move(cells.corners)};
}

}  // namespace

template <int dim>
DistributedMesh<dim> distribute(const Ranks& ranks, ScatteredMesh<dim> mesh) {
  auto [nodes, owns_cell, owners_of_copies] = add_copies(ranks, mesh.cells, choose_owners(mesh));
  const auto part = std::make_shared<const RankPart>(
      ranks, nodes.numbers.numbers(), nodes.owners, std::move(mesh.cells.numbers),
      std::move(owns_cell), std::move(owners_of_copies), mesh.n_cells);
  const auto numbers = part->nodes();
  MeshLabels labels;
  labels.part = part;
  std::vector<std::uint8_t> is_neighbour(static_cast<std::size_t>(ranks.size()), 0);
  for (const int owner : nodes.owners)
    is_neighbour[static_cast<std::size_t>(owner)] = owner != ranks.rank();
  const auto n_neighbours =
      static_cast<std::size_t>(std::count(is_neighbour.begin(), is_neighbour.end(), 1));
  auto rows = local_rows(mesh.cells, nodes.numbers);
  const auto& materials = mesh.cells.materials;
  if (std::any_of(materials.begin(), materials.end(),
                  [&](int material) { return material != materials.front(); }))
    labels.cell_tags = std::move(mesh.cells.materials);
  mesh.cells = {};
  nodes = {NumberSet(0)};
  auto reasons = mesh.nodes.ask(numbers, [](const NodeEntry<dim>& entry) { return entry.reasons; });
  auto topology = make_topology(ranks, dim, numbers.size(), std::move(rows), std::move(labels),
                                std::move(reasons), mesh.fixes_boundary);
  std::vector<Point<dim>> points;
  points.reserve(numbers.size());
  for (const auto& x : mesh.nodes.ask(numbers, [](const NodeEntry<dim>& entry) { return entry.x; }))
    points.push_back(Point<dim>(x.data()));
  return {Mesh<dim>(std::move(topology), std::move(points)), part->n_nodes_of_whole(), n_neighbours,
          std::move(mesh.nodes)};
}

template <int dim>
void store_coordinates(DistributedMesh<dim>& mesh) {
  const Topology& topology = mesh.part.topology();
  std::vector<GlobalIndex> numbers;
  std::vector<NodeEntry<dim>> entries;
  for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
    if (topology.part()->owns_node(i)) {
      numbers.push_back(topology.part()->nodes()[i]);
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
