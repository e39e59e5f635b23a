// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/files/refine.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>
#include <sstream>

#include "distributed/examine_parts.h"
#include "distributed/files/pieces.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/io/vtk/vtk_files.h"
#include "meshes/refinement/split_cells.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {

namespace {

constexpr GlobalIndex no_node_number = std::numeric_limits<GlobalIndex>::max();

/// Ascending numbers of nodes; places that are not used have no_node_number.
template <std::size_t n>
using SortedNumbers = std::array<GlobalIndex, n>;

template <std::size_t n, class Range>
SortedNumbers<n> sorted_numbers(const Range& numbers) {
  SortedNumbers<n> sorted;
  sorted.fill(no_node_number);
  std::copy(std::begin(numbers), std::end(numbers), sorted.begin());
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/// The nodes that a new node is the mean of.
using NewNodeKey = SortedNumbers<8>;

struct NewNode {
  GlobalIndex number;
  bool is_on_boundary;
};

/// A facet that only one cell of a piece has.
struct OuterFacet {
  SortedNumbers<4> key;
  std::array<GlobalIndex, 4> nodes;  ///< in its direction

  std::size_t n_nodes() const {
    return static_cast<std::size_t>(std::find(key.begin(), key.end(), no_node_number) -
                                    key.begin());
  }
};

/// The new nodes of the whole mesh. The rank that keeps the lowest node of a key keeps the new
/// node, so that the order of all keys is that of the ranks and their keys.
template <int dim>
class NewNodes {
 public:
  NewNodes(const Ranks& ranks, const NodeDirectory<NodeEntry<dim>>& nodes)
      : ranks_(ranks), nodes_(nodes) {}

  /// Adds the new nodes and the outer facets of a piece. Collective, as all functions here.
  void add(const std::vector<NewNodeKey>& keys, const std::vector<OuterFacet>& facets) {
    for (const auto& from : ranks_.exchange(by_keeper(keys)))
      keys_.insert(keys_.end(), from.begin(), from.end());
    auto to = for_each_rank<OuterFacet>();
    for (const OuterFacet& facet : facets) to[nodes_.keeper_of(facet.key[0])].push_back(facet);
    for (const auto& from : ranks_.exchange(std::move(to)))
      facets_.insert(facets_.end(), from.begin(), from.end());
  }

  /// Gives all nodes their numbers, from first on. Returns their number.
  std::size_t number_from(std::size_t first) {
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    first_ = first + ranks_.exclusive_scan(keys_.size());
    return ranks_.sum(keys_.size());
  }

  /// Finds the new nodes on the boundary. Returns the nodes of facets there, as this rank knows
  /// them.
  std::vector<GlobalIndex> find_boundary() {
    std::sort(facets_.begin(), facets_.end(),
              [](const OuterFacet& a, const OuterFacet& b) { return a.key < b.key; });
    std::vector<GlobalIndex> nodes;
    std::vector<NewNodeKey> keys;
    for (auto facet = facets_.begin(); facet != facets_.end();) {
      const auto next = std::find_if(facet, facets_.end(),
                                     [&](const OuterFacet& f) { return f.key != facet->key; });
      if (next - facet == 1) add_boundary(*facet, nodes, keys);
      facet = next;
    }
    facets_ = {};
    is_on_boundary_.assign(keys_.size(), false);
    for (const auto& from : ranks_.exchange(by_keeper(keys)))
      for (const NewNodeKey& key : from) is_on_boundary_[position(key)] = true;
    return nodes;
  }

  std::vector<NewNode> ask(const std::vector<NewNodeKey>& keys) const {
    auto answers = for_each_rank<NewNode>();
    const auto asked = ranks_.exchange(by_keeper(keys));
    for (std::size_t r = 0; r < asked.size(); ++r)
      for (const NewNodeKey& key : asked[r])
        answers[r].push_back(
            {static_cast<GlobalIndex>(first_ + position(key)), is_on_boundary_[position(key)]});
    const auto from = ranks_.exchange(std::move(answers));
    std::vector<std::size_t> next(from.size(), 0);
    std::vector<NewNode> result;
    for (const NewNodeKey& key : keys) {
      const std::size_t r = nodes_.keeper_of(key[0]);
      result.push_back(from[r][next[r]++]);
    }
    return result;
  }

 private:
  template <class T>
  std::vector<std::vector<T>> for_each_rank() const {
    return std::vector<std::vector<T>>(static_cast<std::size_t>(ranks_.size()));
  }
  std::vector<std::vector<NewNodeKey>> by_keeper(const std::vector<NewNodeKey>& keys) const {
    auto to = for_each_rank<NewNodeKey>();
    for (const NewNodeKey& key : keys) to[nodes_.keeper_of(key[0])].push_back(key);
    return to;
  }
  std::size_t position(const NewNodeKey& key) const {
    return static_cast<std::size_t>(std::lower_bound(keys_.begin(), keys_.end(), key) -
                                    keys_.begin());
  }
  /// The middles of the edges, and of a quadrilateral. The only edge of a facet in the plane comes
  /// twice.
  static void add_boundary(const OuterFacet& facet, std::vector<GlobalIndex>& nodes,
                           std::vector<NewNodeKey>& keys) {
    const std::size_t n = facet.n_nodes();
    for (std::size_t i = 0; i < n; ++i) {
      nodes.push_back(facet.nodes[i]);
      keys.push_back(sorted_numbers<8>(std::array{facet.nodes[i], facet.nodes[(i + 1) % n]}));
    }
    if (n == 4) keys.push_back(sorted_numbers<8>(facet.nodes));
  }

  const Ranks& ranks_;
  const NodeDirectory<NodeEntry<dim>>& nodes_;
  std::vector<NewNodeKey> keys_;  ///< that this rank keeps
  std::vector<OuterFacet> facets_;
  std::vector<bool> is_on_boundary_;
  std::size_t first_ = 0;
};

/// Returns each text of all ranks once.
std::vector<std::string> on_all_ranks(const Ranks& ranks, const std::set<std::string>& texts) {
  std::string lines;
  for (const std::string& text : texts) lines += text + "\n";
  std::istringstream all(ranks.gather_all(lines));
  std::set<std::string> result;
  for (std::string line; std::getline(all, line);) result.insert(line);
  return {result.begin(), result.end()};
}

template <int dim>
class Refinement {
 public:
  Refinement(const Ranks& ranks, const std::filesystem::path& in, const Pieces& pieces,
             ScatteredMesh<dim> mesh)
      : ranks_(ranks),
        in_(in),
        pieces_(pieces),
        n_old_cells_(mesh.n_cells),
        nodes_(std::move(mesh.nodes)),
        fixes_boundary_(mesh.fixes_boundary),
        new_nodes_(ranks, nodes_) {}

  RefinedPieces write(const std::filesystem::path& out) {
    collect();
    number_cells();
    number_nodes();
    const NewPieces new_pieces(out, ranks_.is_root());
    std::size_t first_cell = 0,  // of this rank's cells
        first_facet = n_cells_ + ranks_.exclusive_scan(n_facets_);
    pieces_.in_rounds([&](std::optional<std::size_t> p) {
      SplitCells<dim> split;
      std::span<const GlobalIndex> numbers;
      ranks_.together([&] {
        if (!p) return;
        numbers = pieces_.nodes(*p);
        split = split_cells(mesh_of(*p, pieces_.parts(*p)), numbers);
      });
      const auto of_new = new_nodes_.ask(keys_of(split, numbers));
      const auto reasons =
          nodes_.ask(numbers, [](const NodeEntry<dim>& entry) { return entry.reasons; });
      ranks_.together([&] {
        if (!p) return;
        const std::size_t n_facets = split.labels.facets.size();
        std::vector<std::int64_t> elements;
        for (std::size_t c = 0; c < split.origins.size(); ++c) {
          const bool is_first = c == 0 || split.origins[c] != split.origins[c - 1];
          elements.push_back(is_first ? first_parts_[first_cell + split.origins[c]]
                                      : elements.back() + 1);
        }
        for (std::size_t f = 0; f < n_facets; ++f)
          elements.push_back(static_cast<std::int64_t>(first_facet + f));
        if (!split.origins.empty()) first_cell += split.origins.back() + 1;
        first_facet += n_facets;
        write_vtu(new_pieces.file(*p),
                  plain(std::move(split), numbers, of_new, reasons, std::move(elements)));
      });
    });
    ranks_.together([&] {
      if (ranks_.is_root()) new_pieces.finish(pieces_.files().size());
    });
    return {pieces_.files().size(), n_cells_, on_all_ranks(ranks_, losses_)};
  }

 private:
  using Numbers = std::span<const GlobalIndex>;

  /// Returns a piece in the order of its file.
  Mesh<dim> mesh_of(std::size_t p, MeshParts parts) const {
    const auto& path = pieces_.files()[p];
    MeshFile file = assemble_mesh(path, std::move(parts), {.turns_over = false});
    auto* const mesh = std::get_if<Mesh<dim>>(&file.mesh);
    if (mesh == nullptr) throw InputError(path.string() + ": has changed since it was read");
    for (CellIndex c = 0; c < mesh->n_cells(); ++c)
      if (mesh->topology().cell_type(c) == ElementType::polygon)
        throw InputError(path.string() + ": cell " + std::to_string(c) + " has " +
                         std::to_string(mesh->topology().cell_nodes(c).size()) +
                         " nodes; only cells with three or four nodes can be split in the plane");
    require_valid(*mesh, path.string(), file.cell_lines);
    return std::move(*mesh);
  }

  static std::vector<NewNodeKey> keys_of(const SplitCells<dim>& split, Numbers numbers) {
    std::vector<NewNodeKey> keys;
    std::vector<GlobalIndex> of_node;
    for (std::size_t i = 0; i < split.means.size(); ++i) {
      of_node.clear();
      for (const NodeIndex node : split.means[i]) of_node.push_back(numbers[node]);
      keys.push_back(sorted_numbers<8>(of_node));
    }
    return keys;
  }

  /// Reads all pieces, and keeps what others must know of them.
  void collect() {
    bool has_numbers = true;
    std::vector<GlobalIndex> labelled;  // nodes of labelled elements that are left out
    pieces_.in_rounds([&](std::optional<std::size_t> p) {
      std::vector<NewNodeKey> keys;
      std::vector<OuterFacet> facets;
      ranks_.together([&] {
        if (!p) return;
        const Numbers numbers = pieces_.nodes(*p);
        MeshParts parts = pieces_.parts(*p);
        const auto of_cells = cell_numbers(parts);
        for (std::size_t d = 0; d + 1 < dim; ++d)
          for (std::size_t e = 0; e < parts.elements[d].nodes.size(); ++e)
            if (!parts.elements[d].tags.empty() && parts.elements[d].tags[e] != 0)
              for (const NodeIndex node : parts.elements[d].nodes[e])
                labelled.push_back(numbers[node]);
        const Mesh<dim> mesh = mesh_of(*p, std::move(parts));
        const SplitCells<dim> split = split_cells(mesh, numbers);
        keys = keys_of(split, numbers);
        const auto& outer = mesh.topology().boundary_facets();
        for (std::size_t f = 0; f < outer.size(); ++f) {
          OuterFacet& facet = facets.emplace_back();
          for (std::size_t i = 0; i < outer[f].size(); ++i) facet.nodes[i] = numbers[outer[f][i]];
          facet.key = sorted_numbers<4>(std::span(facet.nodes).first(outer[f].size()));
        }
        has_numbers = has_numbers && of_cells.size() == mesh.n_cells();
        cells_.insert(cells_.end(), of_cells.begin(), of_cells.end());
        const std::size_t n_before = n_parts_.size();
        n_parts_.resize(n_before + mesh.n_cells(), 0);
        for (const CellIndex origin : split.origins) ++n_parts_[n_before + origin];
        n_facets_ += split.labels.facets.size();
        has_tags_ |= !split.labels.cell_tags.empty() || !split.labels.facets.empty();
        for (std::string& loss : losses_of_splitting(mesh.topology().labels()))
          losses_.insert(std::move(loss));
      });
      new_nodes_.add(keys, facets);
    });
    has_tags_ = ranks_.any(has_tags_);
    // Numbers with large gaps would make a large directory.
    constexpr std::size_t most_a_cell = 16;
    const GlobalIndex largest =
        cells_.empty() ? 0 : *std::max_element(cells_.begin(), cells_.end());
    if (ranks_.any(!has_numbers || largest >= most_a_cell * n_old_cells_)) {
      cells_.resize(n_parts_.size());
      std::iota(cells_.begin(), cells_.end(),
                static_cast<GlobalIndex>(ranks_.exclusive_scan(n_parts_.size())));
    }
    nodes_.name(labelled,
                [](NodeEntry<dim>& entry, int) { entry.reasons |= bit(FixedReason::marked); });
  }

  /// Finds the number of the first part of each cell.
  void number_cells() {
    n_cells_ = ranks_.sum(std::accumulate(n_parts_.begin(), n_parts_.end(), std::size_t{0}));
    require_few(n_cells_ + ranks_.sum(n_facets_), "cells and labelled facets");
    const GlobalIndex largest =
        cells_.empty() ? 0 : *std::max_element(cells_.begin(), cells_.end());
    NodeDirectory<GlobalIndex> directory(
        ranks_, static_cast<std::size_t>(ranks_.max(static_cast<double>(largest))) + 1);
    std::size_t n_twice = 0;
    directory.give(cells_, n_parts_, [&](GlobalIndex& kept, GlobalIndex n_parts, int) {
      n_twice += kept != 0;
      kept = n_parts;
    });
    if (ranks_.any(n_twice > 0))
      throw InputError(in_.string() + ": some cells have the same number; write the pieces anew");
    const auto& entries = directory.entries();
    auto next = static_cast<GlobalIndex>(
        ranks_.exclusive_scan(std::accumulate(entries.begin(), entries.end(), std::size_t{0})));
    for (GlobalIndex& entry : directory.entries()) next += std::exchange(entry, next);
    first_parts_ = directory.ask(cells_, [](GlobalIndex first) { return first; });
    cells_ = {};
    n_parts_ = {};
  }

  void number_nodes() {
    require_few(nodes_.n() + new_nodes_.number_from(nodes_.n()), "nodes");
    const auto on_boundary = new_nodes_.find_boundary();
    if (fixes_boundary_)
      nodes_.name(on_boundary,
                  [](NodeEntry<dim>& entry, int) { entry.reasons |= bit(FixedReason::boundary); });
  }

  void require_few(std::size_t n, const char* what) const {
    if (n >= no_node_number)
      throw InputError(in_.string() + ": the refined mesh would have " + std::to_string(n) + " " +
                       what + ", but at most 4294967294 are possible");
  }

  /// Labelled facets make their nodes stay in any case.
  static bool stays(FixedReasons reasons) { return (reasons & ~bit(FixedReason::interface)) != 0; }

  PlainMesh plain(SplitCells<dim> split, Numbers numbers, const std::vector<NewNode>& of_new,
                  const std::vector<FixedReasons>& reasons,
                  std::vector<std::int64_t> elements) const {
    PlainMesh mesh{
        .dimension = dim, .cells = std::move(split.cells), .labels = std::move(split.labels)};
    FileContent content;
    if (mesh.labels.content) content = *mesh.labels.content;
    std::vector<std::int64_t> nodes(numbers.begin(), numbers.end());
    for (const FixedReasons of_node : reasons) mesh.fixed.push_back(stays(of_node));
    for (std::size_t i = 0; i < of_new.size(); ++i) {
      nodes.push_back(of_new[i].number);
      const auto mean = split.means[i];
      mesh.fixed.push_back(of_new[i].is_on_boundary &&
                           std::all_of(mean.begin(), mean.end(),
                                       [&](NodeIndex node) { return stays(reasons[node]); }));
    }
    for (NodeIndex i = 0; i < split.points.size(); ++i) {
      const Point<dim>& p = split.points[i];
      if constexpr (dim == 3)
        mesh.points.push_back(p);
      else
        mesh.points.push_back(content.plane ? content.plane->in_space(i, p)
                                            : Point<3>(p.x(), p.y(), 0.0));
    }
    if (has_tags_) mesh.labels.cell_tags.resize(mesh.cells.size(), 0);  // the same in all pieces
    add_global_ids("GlobalNodeId", std::move(nodes), content.node_fields, content.node_roles);
    add_global_ids("GlobalCellId", std::move(elements), content.element_fields,
                   content.element_roles);
    mesh.labels.content = std::make_shared<const FileContent>(std::move(content));
    return mesh;
  }

  const Ranks& ranks_;
  const std::filesystem::path& in_;
  const Pieces& pieces_;
  std::size_t n_old_cells_;
  NodeDirectory<NodeEntry<dim>> nodes_;
  bool fixes_boundary_;
  NewNodes<dim> new_nodes_;
  std::vector<GlobalIndex> cells_, n_parts_, first_parts_;  ///< of this rank's cells, by piece
  std::size_t n_cells_ = 0, n_facets_ = 0;                  ///< of the result; of this rank
  bool has_tags_ = false;
  std::set<std::string> losses_;
};

}  // namespace

RefinedPieces refine_pieces(const Ranks& ranks, const std::filesystem::path& in,
                            const std::filesystem::path& out) {
  if (!Pieces::is_list(in))
    throw InputError(in.string() + " is no mesh in pieces; make one by 'smoothfem convert " +
                     in.string() + " pieces.pvtu --pieces N', and refine that");
  if (!Pieces::is_list(out))
    throw InputError("a refined mesh in pieces is a .pvtu file; name one, not " + out.string());
  const Pieces pieces(ranks, in);
  ranks.together([&] {
    if (!ranks.is_root()) return;
    require_other_files(pieces.input_files(), files_of_list(out, pieces.files().size()));
  });
  auto mesh = std::make_unique<std::variant<ScatteredMesh<2>, ScatteredMesh<3>>>(pieces.read());
  return std::visit(
      [&]<int dim>(ScatteredMesh<dim>& of_dim) {
        // Both sides of a facet with hanging nodes would become a boundary.
        auto notes = require_conforming_parts(
            ranks, in,
            ScatteredMesh<dim>{
                .n_cells = of_dim.n_cells, .cells = std::move(of_dim.cells), .nodes = of_dim.nodes},
            {FindingKind::hanging_nodes}, "--refine in parts");
        of_dim.cells = {};
        auto refined = Refinement<dim>(ranks, in, pieces, std::move(of_dim)).write(out);
        refined.notes = pieces.notes();
        refined.notes.insert(refined.notes.end(), notes.begin(), notes.end());
        return refined;
      },
      *mesh);
}

}  // namespace smoothfem
