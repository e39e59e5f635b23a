// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/examine_parts.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <tuple>

#include "distributed/partition.h"
#include "meshes/doctor/examinations/disjoint_sets.h"
#include "meshes/doctor/examinations/orientation.h"
#include "meshes/doctor/examinations/same_cells.h"
#include "meshes/doctor/examine_boundary.h"

namespace smoothfem {

namespace {

constexpr std::size_t most_cells_at_boundary = 50'000'000;  // about 10 GiB on the root
constexpr GlobalIndex none = std::numeric_limits<GlobalIndex>::max();

/// Nodes of a facet, ascending; the rest is `none`. Also a number by which faults are ordered.
using Key = std::array<GlobalIndex, 4>;

/// The faults of one kind that a rank sees, or all see together.
struct Faults {
  std::size_t n = 0;
  Key first{none, none, none, none};  ///< key of the first one
  GlobalIndex node = none;            ///< where it lies
  GlobalIndex cell = none;

  void add(const Key& key, GlobalIndex its_node, GlobalIndex its_cell) {
    ++n;
    if (key < first) std::tie(first, node, cell) = std::tuple(key, its_node, its_cell);
  }
};

/// Faults of a kind, and what the finding names.
struct KindOfFaults {
  FindingKind kind;
  Faults faults;
  bool names_node, names_cell;
};

/// A node, as the ranks use it.
struct NodeUse {
  std::uint32_t n_ranks = 0;
  bool is_on_skin = false;
};

/// Two groups, on any ranks, that belong together. turned: their directions are opposite.
struct Link {
  GlobalIndex a, b, turned;

  auto operator<=>(const Link&) const = default;
};

void sort_unique(std::vector<Link>& links) {
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
}

/// A facet that cells of several ranks may have, as one of its cells has it.
struct SharedFacet {
  Key nodes;
  GlobalIndex cell, position;  ///< number of the cell in the whole mesh, and of the facet in it
  std::uint32_t cycle;         ///< of CellFacet
  std::uint32_t local;         ///< position of the cell on its rank
  GlobalIndex group;           ///< cells that the rank has joined
  std::uint32_t turned;        ///< whether the cell is, relative to the group's first one
  int rank;

  bool same_nodes(const SharedFacet& other) const { return nodes == other.nodes; }
  bool operator<(const SharedFacet& other) const {
    return std::tie(nodes, cell, position) < std::tie(other.nodes, other.cell, other.position);
  }
};

/// Cells of a rank that are joined by facets, for the cells as they are relative to the first one.
struct Group {
  GlobalIndex first_cell, node;  ///< its number, and that of its first node
  std::uint32_t is_one_sided = 0;
  double size = 0.0;  ///< total area or volume

  /// Whether the first cell runs in the wrong direction.
  bool is_reversed() const { return size < 0.0; }
};

/// A facet of the boundary.
struct SkinFacet {
  GlobalIndex cell, position;
};

template <int dim>
class PartsExaminer {
 public:
  PartsExaminer(const Ranks& ranks, ScatteredMesh<dim> mesh)
      : ranks_(ranks), mesh_(std::move(mesh)), uses_(ranks, mesh_.nodes.n()) {
    require_usable();
    if (mesh_.n_cells >= n_ranks()) mesh_ = balanced(ranks, std::move(mesh_));
    NumberSet set(mesh_.nodes.n());
    for (const GlobalIndex node : mesh_.cells.corners) set.add(node);
    set.count();
    nodes_ = set.numbers();
    for (GlobalIndex& corner : mesh_.cells.corners) corner = set.position(corner);
    cells_ =
        CompressedRows<NodeIndex>(std::move(mesh_.cells.offsets), std::move(mesh_.cells.corners));
    numbers_ = std::move(mesh_.cells.numbers);
    uses_.name(nodes_, [](NodeUse& use, int) { ++use.n_ranks; });
    is_shared_ =
        uses_.ask(nodes_, [](const NodeUse& use) { return std::uint8_t{use.n_ranks > 1}; });
    for (const auto& x : mesh_.nodes.ask(nodes_, [](const auto& entry) { return entry.x; }))
      points_.push_back(in_space(x));
  }

  Examination examine() {
    Examination seen{.mesh_kind = mesh_kind_name(dim, dim),
                     .n_cells = mesh_.n_cells,
                     .n_pieces = count_pieces(),
                     .findings = {}};
    std::vector<KindOfFaults> kinds;
    add_unusable_cells(kinds);
    seen.n_nodes = add_unused_nodes(kinds);
    add_directions_and_facets(kinds);
    seen.findings = findings_of(kinds);
    const auto seams = seam_findings(seen);
    seen.findings.insert(seen.findings.end(), seams.begin(), seams.end());
    if (mesh_.joins_places)
      seen.not_looked_for.emplace_back(
          "coincident nodes with equal coordinates are not looked for: the pieces do not number "
          "their nodes, so that such nodes are one");
    std::size_t n = seen.findings.size();
    ranks_.broadcast(n);
    seen.findings.resize(n);
    return seen;
  }

 private:
  using Points = std::vector<Point<3>>;

  static Point<3> in_space(const std::array<double, static_cast<std::size_t>(dim)>& x) {
    Point<3> p = Point<3>::Zero();
    for (std::size_t d = 0; d < x.size(); ++d) p[static_cast<Eigen::Index>(d)] = x[d];
    return p;
  }

  std::size_t n_ranks() const { return static_cast<std::size_t>(ranks_.size()); }
  /// Lists to send, one for each rank.
  template <class T>
  std::vector<std::vector<T>> to_ranks() const {
    return std::vector<std::vector<T>>(n_ranks());
  }
  /// True if cells of other ranks may have these nodes, too.
  bool are_shared(std::span<const NodeIndex> nodes) const {
    return std::all_of(nodes.begin(), nodes.end(), [&](NodeIndex i) { return is_shared_[i] != 0; });
  }

  /// Throws InputError for coordinates and cells with which no examination can work.
  void require_usable() const {
    if (mesh_.n_cells == 0) throw InputError("the mesh has no cells");
    ranks_.together([&] {
      MeshParts kept;  // by this rank
      const auto& entries = mesh_.nodes.entries();
      for (std::size_t i = 0; i < entries.size(); ++i) {
        if (entries[i].owner == NodeEntry<dim>::not_given) continue;
        kept.coordinates.push_back(in_space(entries[i].x));
        kept.node_ids.push_back(mesh_.node_ids ? mesh_.node_ids->entries()[i]
                                               : mesh_.nodes.first() + i);
      }
      require_usable_coordinates(kept);
    });
    GlobalIndex odd = none;
    std::size_t its_size = 0;
    for (std::size_t c = mesh_.cells.size(); c-- > 0;)
      if (const std::size_t n = mesh_.cells[c].size(); !is_cell_size(dim, n)) {
        odd = mesh_.cells.numbers[c];
        its_size = n;
      }
    ranks_.together([&] {
      if (odd != none)
        throw CellError(odd, "has " + count_of(its_size, "node") + ", which no cell can have");
    });
    auto to = to_ranks<GlobalIndex>();
    for (const GlobalIndex number : mesh_.cells.numbers) to[number % n_ranks()].push_back(number);
    std::vector<GlobalIndex> all;
    for (const auto& of_rank : ranks_.exchange(std::move(to)))
      all.insert(all.end(), of_rank.begin(), of_rank.end());
    std::sort(all.begin(), all.end());
    const auto last = std::unique(all.begin(), all.end());
    if (const std::size_t n = ranks_.sum(static_cast<std::size_t>(all.end() - last)); n > 0)
      throw InputError(count_of(n, "cell") + (n == 1 ? " has" : " have") +
                       " the number of another cell; write the pieces anew");
  }

  /// Returns the number of parts without a common node.
  std::size_t count_pieces() {
    DisjointSets sets(nodes_.size());
    for (std::size_t c = 0; c < cells_.size(); ++c)
      for (const NodeIndex node : cells_[c]) sets.join(cells_[c][0], node);
    // The pieces of this rank that other ranks may continue get numbers.
    std::vector<GlobalIndex> piece(nodes_.size(), none);
    for (NodeIndex i = 0; i < nodes_.size(); ++i)
      if (is_shared_[i]) piece[sets.first_of(i)] = 0;
    std::size_t n_shared = 0, n_inside = 0;
    for (NodeIndex i = 0; i < nodes_.size(); ++i) {
      n_inside += sets.first_of(i) == i && piece[i] == none;
      n_shared += piece[i] == 0;
    }
    auto next = static_cast<GlobalIndex>(ranks_.exclusive_scan(n_shared));
    for (GlobalIndex& number : piece)
      if (number == 0) number = next++;
    auto to = to_ranks<std::array<GlobalIndex, 2>>();
    for (NodeIndex i = 0; i < nodes_.size(); ++i)
      if (is_shared_[i]) to[nodes_[i] % n_ranks()].push_back({nodes_[i], piece[sets.first_of(i)]});
    std::vector<std::array<GlobalIndex, 2>> all;
    for (const auto& of_rank : ranks_.exchange(std::move(to)))
      all.insert(all.end(), of_rank.begin(), of_rank.end());
    std::sort(all.begin(), all.end());
    std::vector<Link> links;
    for (std::size_t k = 1; k < all.size(); ++k)
      if (all[k][0] == all[k - 1][0]) links.push_back({all[k - 1][1], all[k][1], 0});
    sort_unique(links);
    const std::size_t n_all_shared = ranks_.sum(n_shared);
    DisjointSets joined(ranks_.is_root() ? n_all_shared : 0);
    for (const Link& link : ranks_.gather(links)) joined.join(link.a, link.b);
    for (std::uint32_t i = 0; ranks_.is_root() && i < n_all_shared; ++i)
      n_inside += joined.first_of(i) == i;
    return ranks_.sum(n_inside);
  }

  /// Adds faults of cells on this rank.
  void add_cells(FindingKind kind, std::span<const std::uint32_t> cells,
                 std::vector<KindOfFaults>& kinds) const {
    Faults faults;
    for (const std::uint32_t c : cells)
      faults.add({numbers_[c], 0, 0, 0}, nodes_[cells_[c][0]], numbers_[c]);
    kinds.push_back({kind, faults, false, true});
  }

  /// Adds cells that name a node twice, and cells with the nodes of another one. Keeps the rest.
  void add_unusable_cells(std::vector<KindOfFaults>& kinds) {
    const auto collapsed = collapsed_cells(cells_), doubled = all_doubled_cells();
    add_cells(FindingKind::collapsed_cells, collapsed, kinds);
    add_cells(FindingKind::doubled_cells, doubled, kinds);
    if (collapsed.empty() && doubled.empty()) return;
    std::vector<bool> usable(cells_.size(), true);
    for (const auto* unusable : {&collapsed, &doubled})
      for (const std::uint32_t c : *unusable) usable[c] = false;
    CompressedRows<NodeIndex> rest;
    std::vector<GlobalIndex> numbers;
    for (std::size_t c = 0; c < cells_.size(); ++c)
      if (usable[c]) {
        rest.append(cells_[c]);
        numbers.push_back(numbers_[c]);
      }
    cells_ = std::move(rest);
    numbers_ = std::move(numbers);
  }

  /// Returns the cells of this rank with the nodes of a cell of lower number, on any rank.
  std::vector<std::uint32_t> all_doubled_cells() const {
    auto found = doubled_cells(cells_);
    auto to = to_ranks<GlobalIndex>();  // number, position on its rank, number of nodes, nodes
    std::vector<GlobalIndex> row;
    for (std::uint32_t c = 0; c < cells_.size(); ++c) {
      if (!are_shared(cells_[c])) continue;
      row.clear();
      for (const NodeIndex i : cells_[c]) row.push_back(nodes_[i]);
      std::sort(row.begin(), row.end());
      auto& words = to[row.front() % n_ranks()];
      words.insert(words.end(), {numbers_[c], c, static_cast<GlobalIndex>(row.size())});
      words.insert(words.end(), row.begin(), row.end());
    }
    const auto received = ranks_.exchange(std::move(to));
    struct SharedCell {
      std::span<const GlobalIndex> nodes;
      GlobalIndex number, local;
      std::size_t rank;
    };
    std::vector<SharedCell> cells;
    for (std::size_t r = 0; r < received.size(); ++r)
      for (std::size_t at = 0; at < received[r].size(); at += 3 + received[r][at + 2]) {
        const GlobalIndex* const words = &received[r][at];
        cells.push_back({{words + 3, words[2]}, words[0], words[1], r});
      }
    std::sort(cells.begin(), cells.end(), [](const SharedCell& a, const SharedCell& b) {
      const auto order = std::lexicographical_compare_three_way(a.nodes.begin(), a.nodes.end(),
                                                                b.nodes.begin(), b.nodes.end());
      return order != 0 ? order < 0 : a.number < b.number;
    });
    auto answers = to_ranks<std::uint32_t>();
    for (std::size_t k = 1; k < cells.size(); ++k)
      if (std::ranges::equal(cells[k].nodes, cells[k - 1].nodes))
        answers[cells[k].rank].push_back(cells[k].local);
    for (const auto& of_rank : ranks_.exchange(std::move(answers)))
      found.insert(found.end(), of_rank.begin(), of_rank.end());
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  /// Returns the number of all nodes.
  std::size_t add_unused_nodes(std::vector<KindOfFaults>& kinds) {
    std::size_t n = 0;
    Faults faults;
    const auto& entries = mesh_.nodes.entries();
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (entries[i].owner == NodeEntry<dim>::not_given) continue;
      ++n;
      const auto number = static_cast<GlobalIndex>(mesh_.nodes.first() + i);
      if (uses_.entries()[i].n_ranks == 0) faults.add({number, 0, 0, 0}, number, none);
    }
    kinds.push_back({FindingKind::unused_nodes, faults, true, false});
    return ranks_.sum(n);
  }

  /// Adds cells in the wrong direction, invalid cells and facets of many cells. Finds the boundary.
  void add_directions_and_facets(std::vector<KindOfFaults>& kinds) {
    const PlainCells cells{dim, cells_, points_, dim == 2};
    DisjointSets groups(cells_.size());
    std::vector<CellIndex> contradictions;
    std::vector<std::pair<NodeIndex, CellFacet>> shared;
    Faults crowded, one_sided;
    std::optional<FacetTable> table;
    ranks_.together([&] { table.emplace(cells); });  // a rank may have too many facets
    table->for_each([&](NodeIndex node, std::span<const CellFacet> facet) {
      const auto& others = facet[0].others;
      if (is_shared_[node] &&
          are_shared({others.data(),
                      static_cast<std::size_t>(std::find(others.begin(), others.end(), no_node) -
                                               others.begin())})) {
        for (const CellFacet& of_cell : facet) shared.emplace_back(node, of_cell);
        return;
      }
      if (facet.size() == 1) skin_.emplace_back(facet[0].cell, facet[0].position);
      if (facet.size() > 2)
        crowded.add(key_of(node, facet[0]), nodes_[node], numbers_[facet[2].cell]);
      if (facet.size() != 2) return;
      const bool turned = facet[0].same_direction(facet[1]);
      if (!turned && !facet[0].is_opposite(facet[1])) return;  // a face with crossing sides
      if (!groups.join(facet[0].cell, facet[1].cell, turned))
        contradictions.push_back(facet[0].cell);
    });
    table.reset();
    std::vector<Group> all(cells_.size());
    for (CellIndex c = 0; c < cells_.size(); ++c) {
      const auto [first, turned] = groups.place_of(c);
      if (first == c) all[c] = {.first_cell = numbers_[c], .node = nodes_[cells_[c][0]]};
      all[first].size += (turned ? -1.0 : 1.0) * signed_size(cells, c);
    }
    for (const CellIndex c : contradictions) all[groups.first_of(c)].is_one_sided = 1;
    // Groups that other ranks may continue get numbers.
    std::vector<GlobalIndex> number(cells_.size(), none);
    for (const auto& [node, facet] : shared) number[groups.first_of(facet.cell)] = 0;
    std::vector<Group> open;
    for (CellIndex c = 0; c < cells_.size(); ++c)
      if (number[c] == 0) open.push_back(all[c]);
    auto next = static_cast<GlobalIndex>(ranks_.exclusive_scan(open.size()));
    for (GlobalIndex& of_group : number)
      if (of_group == 0) of_group = next++;
    auto to = to_ranks<SharedFacet>();
    for (const auto& [node, facet] : shared) {
      const auto [first, turned] = groups.place_of(facet.cell);
      to[nodes_[node] % n_ranks()].push_back({key_of(node, facet), numbers_[facet.cell],
                                              facet.position, facet.cycle, facet.cell,
                                              number[first], turned, ranks_.rank()});
    }
    shared = {};
    const auto links = links_between(ranks_.exchange(std::move(to)), crowded);
    const auto joined = joined_groups(std::move(open), links);
    std::size_t k = 0;
    for (CellIndex c = 0; c < cells_.size(); ++c)
      if (number[c] != none) all[c] = joined[k++];
    std::vector<CellIndex> reversed, folded;
    for (CellIndex c = 0; c < cells_.size(); ++c) {
      const auto [first, turned] = groups.place_of(c);
      const Group& group = all[first];
      if (group.is_one_sided && first == c)
        one_sided.add({group.first_cell, 0, 0, 0}, group.node, group.first_cell);
      if (!group.is_one_sided && turned != group.is_reversed()) reversed.push_back(c);
    }
    one_sided.n = std::min<std::size_t>(one_sided.n, 1);
    const auto right = with_reversed(dim, cells_, reversed);
    for (CellIndex c = 0; c < right.size(); ++c)
      if (is_invalid(cells, right[c])) folded.push_back(c);
    add_cells(FindingKind::reversed_cells, reversed, kinds);
    kinds.push_back({FindingKind::one_sided, one_sided, false, true});
    add_cells(FindingKind::folded_cells, folded, kinds);
    kinds.push_back({FindingKind::crowded_facets, crowded, true, true});
  }

  Key key_of(NodeIndex node, const CellFacet& facet) const {
    Key key{nodes_[node], none, none, none};
    for (std::size_t k = 0; k < facet.others.size() && facet.others[k] != no_node; ++k)
      key[k + 1] = nodes_[facet.others[k]];
    return key;
  }

  /// Looks at the facets that this rank compares. Returns which groups of cells they join.
  std::vector<Link> links_between(const std::vector<std::vector<SharedFacet>>& of_ranks,
                                  Faults& crowded) {
    std::vector<SharedFacet> facets;
    for (const auto& of_rank : of_ranks)
      facets.insert(facets.end(), of_rank.begin(), of_rank.end());
    std::sort(facets.begin(), facets.end());
    std::vector<Link> links;
    auto on_skin = to_ranks<std::array<std::uint32_t, 2>>();
    for (std::size_t first = 0, last = 0; first < facets.size(); first = last) {
      while (last < facets.size() && facets[last].same_nodes(facets[first])) ++last;
      const SharedFacet& a = facets[first];
      if (last - first == 1)
        on_skin[static_cast<std::size_t>(a.rank)].push_back({a.local, a.position});
      if (last - first > 2) crowded.add(a.nodes, a.nodes[0], facets[first + 2].cell);
      if (last - first != 2) continue;
      const SharedFacet& b = facets[first + 1];
      const CellFacet of_a{{}, 0, 0, a.cycle}, of_b{{}, 0, 0, b.cycle};
      const bool turned = of_a.same_direction(of_b);
      if (!turned && !of_a.is_opposite(of_b)) continue;
      links.push_back({a.group, b.group, a.turned ^ b.turned ^ std::uint32_t{turned}});
    }
    for (const auto& of_rank : ranks_.exchange(std::move(on_skin)))
      for (const auto& [cell, position] : of_rank) skin_.emplace_back(cell, position);
    sort_unique(links);
    return links;
  }

  /// Joins groups of all ranks. Returns the groups of this rank with the first cell, the size and
  /// the sides of the whole group, all relative to the first cell before.
  std::vector<Group> joined_groups(std::vector<Group> open, const std::vector<Link>& links) const {
    const std::vector<std::size_t> counts = ranks_.gather(std::vector<std::size_t>{open.size()});
    std::vector<Group> all = ranks_.gather(open);
    const std::vector<Link> all_links = ranks_.gather(links);
    auto answers = to_ranks<Group>();
    if (ranks_.is_root()) {
      // In the order of their first cells, so that the first member of a set has the first cell.
      std::vector<std::uint32_t> order(all.size()), place(all.size());
      for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
      std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return all[a].first_cell < all[b].first_cell;
      });
      for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
      DisjointSets sets(all.size());
      std::vector<std::uint32_t> contradictions;
      for (const Link& link : all_links)
        if (!sets.join(place[link.a], place[link.b], link.turned != 0))
          contradictions.push_back(place[link.a]);
      std::vector<Group> sums(all.size());
      for (std::uint32_t i = 0; i < order.size(); ++i) {
        const auto [first, turned] = sets.place_of(i);
        const Group& group = all[order[i]];
        if (first == i) sums[i] = {.first_cell = group.first_cell, .node = group.node};
        sums[first].size += (turned ? -1.0 : 1.0) * group.size;
        sums[first].is_one_sided |= group.is_one_sided;
      }
      for (const std::uint32_t i : contradictions) sums[sets.first_of(i)].is_one_sided = 1;
      for (std::uint32_t i = 0; i < order.size(); ++i) {
        const auto [first, turned] = sets.place_of(i);
        Group& group = all[order[i]];
        group = sums[first];
        // A group whose size is 0 is as its first cell.
        const bool is_reversed = turned != sums[first].is_reversed();
        group.size = is_reversed ? -1.0 : 1.0;
      }
      auto next = all.begin();
      for (std::size_t r = 0; r < counts.size(); ++r) {
        const auto end = next + static_cast<std::ptrdiff_t>(counts[r]);
        answers[r].assign(next, end);
        next = end;
      }
    }
    return ranks_.exchange(std::move(answers)).front();
  }

  /// Returns the numbers that the file has, or those in the whole mesh.
  static std::vector<std::size_t> ids_of(const std::optional<NodeDirectory<std::size_t>>& ids,
                                         std::span<const GlobalIndex> numbers) {
    if (ids) return ids->ask(numbers, [](std::size_t id) { return id; });
    return {numbers.begin(), numbers.end()};
  }

  /// Returns the findings, on the root.
  std::vector<Finding> findings_of(const std::vector<KindOfFaults>& kinds) const {
    std::vector<KindOfFaults> found;
    std::vector<GlobalIndex> nodes, numbers_of_cells;
    for (KindOfFaults kind : kinds) {
      const auto all = ranks_.gather(std::vector<Faults>{kind.faults});
      kind.faults = {};
      for (const Faults& of_rank : all) {
        const std::size_t n = kind.faults.n + of_rank.n;
        if (of_rank.first < kind.faults.first) kind.faults = of_rank;
        kind.faults.n = n;
      }
      if (kind.kind == FindingKind::one_sided)
        kind.faults.n = std::min<std::size_t>(kind.faults.n, 1);
      if (kind.faults.n == 0) continue;
      found.push_back(kind);
      nodes.push_back(kind.faults.node);
      if (kind.names_cell) numbers_of_cells.push_back(kind.faults.cell);
    }
    const auto places = mesh_.nodes.ask(nodes, [](const auto& entry) { return entry.x; });
    const auto node_ids = ids_of(mesh_.node_ids, nodes),
               cell_ids = ids_of(mesh_.cell_ids, numbers_of_cells);
    const CompressedRows<NodeIndex> no_cells;
    const PlainCells whole{dim, no_cells, {}, dim == 2};
    Findings findings(whole);
    auto cell_id = cell_ids.begin();
    for (std::size_t k = 0; k < found.size(); ++k) {
      const FindingKind kind = found[k].kind;
      Finding finding{kind, found[k].faults.n,  in_space(places[k]), {}, {},
                      {},   is_repairable(kind)};
      if (found[k].names_node) finding.node = node_ids[k];
      if (found[k].names_cell) finding.cell = *cell_id++;
      findings.add(std::move(finding));
    }
    return std::move(findings).take();
  }

  /// Returns flags of the nodes of this rank that are on the boundary of the whole mesh.
  std::vector<bool> skin_flags() {
    std::vector<bool> flags(nodes_.size(), false);
    std::vector<GlobalIndex> named, asked;
    std::vector<NodeIndex> shared;
    const Skin skin = skin_of(PlainCells{dim, cells_, points_, dim == 2}, skin_);
    for (const NodeIndex i : skin.nodes) {
      flags[i] = true;
      if (is_shared_[i]) named.push_back(nodes_[i]);
    }
    for (NodeIndex i = 0; i < nodes_.size(); ++i)
      if (is_shared_[i] && !flags[i]) {
        shared.push_back(i);
        asked.push_back(nodes_[i]);
      }
    uses_.name(named, [](NodeUse& use, int) { use.is_on_skin = true; });
    const auto answers =
        uses_.ask(asked, [](const NodeUse& use) { return std::uint8_t{use.is_on_skin}; });
    for (std::size_t k = 0; k < shared.size(); ++k) flags[shared[k]] = answers[k] != 0;
    return flags;
  }

  /// Returns what examine() finds at the boundary, on the root, which gets all cells with a node
  /// there. Cells keep their order, so that numbers that others compare do, too.
  std::vector<Finding> seam_findings(Examination& seen) {
    const auto flags = skin_flags();
    std::vector<CellIndex> at_boundary;
    for (CellIndex c = 0; c < cells_.size(); ++c)
      if (std::any_of(cells_[c].begin(), cells_[c].end(), [&](NodeIndex i) { return flags[i]; }))
        at_boundary.push_back(c);
    if (const std::size_t n = ranks_.sum(at_boundary.size()); n > most_cells_at_boundary) {
      seen.not_looked_for.push_back(
          "hanging nodes, coincident nodes and pieces that touch are not looked for: " +
          std::to_string(n) + " cells have a node on the boundary, more than " +
          std::to_string(most_cells_at_boundary));
      return {};
    }
    auto words = to_ranks<GlobalIndex>();
    auto facets = to_ranks<SkinFacet>();
    for (const CellIndex c : at_boundary) {
      words[0].insert(words[0].end(), {numbers_[c], 0, static_cast<GlobalIndex>(cells_[c].size())});
      for (const NodeIndex i : cells_[c]) words[0].push_back(nodes_[i]);
    }
    for (const auto& [cell, position] : skin_) facets[0].push_back({numbers_[cell], position});
    const CellTable table = sorted_cells(ranks_.exchange(std::move(words)), 0);
    const auto all_facets = ranks_.exchange(std::move(facets));
    std::vector<GlobalIndex> nodes = table.corners;
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    const auto place_in = [](const std::vector<GlobalIndex>& sorted, GlobalIndex number) {
      return static_cast<std::uint32_t>(std::lower_bound(sorted.begin(), sorted.end(), number) -
                                        sorted.begin());
    };
    Points points;
    for (const auto& x : mesh_.nodes.ask(nodes, [](const auto& entry) { return entry.x; }))
      points.push_back(in_space(x));
    const auto node_ids = ids_of(mesh_.node_ids, nodes),
               cell_ids = ids_of(mesh_.cell_ids, table.numbers);
    if (table.size() == 0) return {};
    std::vector<NodeIndex> corners;
    corners.reserve(table.corners.size());
    for (const GlobalIndex corner : table.corners) corners.push_back(place_in(nodes, corner));
    const CompressedRows<NodeIndex> rows(table.offsets, std::move(corners));
    const PlainCells cells{dim, rows, points, dim == 2};
    std::vector<std::pair<CellIndex, std::uint32_t>> skin;
    for (const auto& of_rank : all_facets)
      for (const SkinFacet& facet : of_rank)
        skin.emplace_back(place_in(table.numbers, facet.cell), facet.position);
    Findings findings(cells, {true, node_ids, cell_ids});
    (void)add_seams(findings, skin_of(cells, std::move(skin)));
    return std::move(findings).take();
  }

  Ranks ranks_;
  ScatteredMesh<dim> mesh_;              ///< its cells are in the members below
  NodeDirectory<NodeUse> uses_;          ///< of all nodes
  std::vector<GlobalIndex> nodes_;       ///< of this rank's cells, ascending
  CompressedRows<NodeIndex> cells_;      ///< of this rank, with positions in `nodes_`
  std::vector<GlobalIndex> numbers_;     ///< of these cells
  std::vector<std::uint8_t> is_shared_;  ///< nodes that other ranks have, too
  Points points_;
  std::vector<std::pair<CellIndex, std::uint32_t>> skin_;  ///< cell and position of its facets
};

}  // namespace

template <int dim>
Examination examine_parts(const Ranks& ranks, ScatteredMesh<dim> mesh) {
  return PartsExaminer<dim>(ranks, std::move(mesh)).examine();
}

template <int dim>
std::vector<std::string> require_conforming_parts(const Ranks& ranks,
                                                  const std::filesystem::path& path,
                                                  ScatteredMesh<dim> mesh,
                                                  std::initializer_list<FindingKind> faults,
                                                  const std::string& purpose) {
  Examination seen;
  try {
    seen = examine_parts(ranks, std::move(mesh));
  } catch (const InputError& error) {
    throw InputError(path.string() + ": " + error.what());
  }
  ranks.together([&] {
    if (!ranks.is_root()) return;
    for (const Finding& finding : seen.findings)
      if (std::find(faults.begin(), faults.end(), finding.kind) != faults.end())
        throw InputError(path.string() + ": " + finding.sentence + "; " + purpose +
                         " needs a mesh that conforms");
  });
  return seen.not_looked_for;
}

template Examination examine_parts(const Ranks&, ScatteredMesh<2>);
template Examination examine_parts(const Ranks&, ScatteredMesh<3>);
template std::vector<std::string> require_conforming_parts(const Ranks&,
                                                           const std::filesystem::path&,
                                                           ScatteredMesh<2>,
                                                           std::initializer_list<FindingKind>,
                                                           const std::string&);
template std::vector<std::string> require_conforming_parts(const Ranks&,
                                                           const std::filesystem::path&,
                                                           ScatteredMesh<3>,
                                                           std::initializer_list<FindingKind>,
                                                           const std::string&);

}  // namespace smoothfem
