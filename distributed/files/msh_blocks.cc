// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/files/msh_blocks.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "meshes/io/atomic_file.h"
#include "meshes/io/file_parts.h"

namespace smoothfem {

namespace {

constexpr GlobalIndex no_number = std::numeric_limits<GlobalIndex>::max();

/// Calls visit(block, first, last) for the items of some blocks that a rank handles: its share of
/// all items.
template <class Block, class Visit>
void for_share(const std::vector<Block>& blocks, const Ranks& ranks, int rank, const Visit& visit) {
  std::uint64_t n = 0;
  for (const Block& block : blocks) n += block.n;
  const std::uint64_t first = first_of_share(ranks, n, rank),
                      last = first_of_share(ranks, n, rank + 1);
  std::uint64_t at = 0;
  for (const Block& block : blocks) {
    const auto inside = [&](std::uint64_t i) { return std::clamp(i, at, at + block.n) - at; };
    if (inside(first) < inside(last)) visit(block, inside(first), inside(last));
    at += block.n;
  }
}

/// Returns the coordinates of some nodes of a block.
std::vector<double> points_of(const FileParts& file, const MshNodeBlock& block, std::uint64_t first,
                              std::uint64_t last) {
  const auto size = static_cast<std::size_t>(block.n_numbers);
  return file.numbers<double>(block.points_at + 8 * size * first, size * (last - first));
}

/// Throws InputError for a tag that is larger than the file announces.
GlobalIndex small_tag(const std::filesystem::path& path, std::uint64_t tag, std::uint64_t most) {
  if (tag > most)
    throw InputError(path.string() + ": the file has the tag " + std::to_string(tag) +
                     ", but announces " + std::to_string(most) +
                     " as the largest one; it is damaged");
  return static_cast<GlobalIndex>(tag);
}

/// Makes each value appear once, in ascending order.
void sort_unique(std::vector<GlobalIndex>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// Elements of a range, with tags of nodes.
struct Elements {
  CellTable cells;                    ///< by their tags, in the order of the file
  std::vector<GlobalIndex> used;      ///< nodes of all elements but points, sorted
  std::vector<GlobalIndex> labelled;  ///< nodes of elements of lower dimension in a group
};

template <int dim>
Elements read_elements(const std::filesystem::path& path, const MshLayout& layout,
                       const Ranks& ranks) {
  constexpr std::uint64_t most_at_once = 1 << 16;
  const FileParts file(path);
  Elements elements;
  std::vector<GlobalIndex> row;
  const auto read_some = [&](const MshElementBlock& block, std::uint64_t first,
                             std::uint64_t last) {
    const std::size_t size = 1 + block.n_nodes;
    const auto words =
        file.numbers<std::uint64_t>(block.at + 8 * size * first, size * (last - first));
    for (std::size_t i = 0; i < words.size(); i += size) {
      row.clear();
      for (std::size_t k = 1; k < size; ++k)
        row.push_back(small_tag(path, words[i + k], layout.last_node));
      if (block.dimension == dim)
        elements.cells.append(small_tag(path, words[i], layout.last_element), block.material, row);
      else if (block.dimension > 0)
        elements.used.insert(elements.used.end(), row.begin(), row.end());
      if (block.dimension < dim && block.has_group)
        elements.labelled.insert(elements.labelled.end(), row.begin(), row.end());
    }
  };
  for_share(layout.elements, ranks, ranks.rank(),
            [&](const MshElementBlock& block, std::uint64_t first, std::uint64_t last) {
              for (; first < last; first += most_at_once)
                read_some(block, first, std::min(last, first + most_at_once));
            });
  elements.used.insert(elements.used.end(), elements.cells.corners.begin(),
                       elements.cells.corners.end());
  sort_unique(elements.used);
  return elements;
}

/// A tag as the directory of tags keeps it.
struct TaggedNode {
  std::array<double, 3> x{};
  std::uint32_t n_given = 0;
  bool is_used = false, is_labelled = false;
  GlobalIndex number = no_number;
};

struct TaggedCell {
  std::uint32_t n_given = 0;
  GlobalIndex number = no_number;
};

/// Numbers the entries of all ranks for which `counts` is true, in their order. Returns how many
/// there are.
template <class Entry, class Counts>
std::size_t number_entries(const Ranks& ranks, NodeDirectory<Entry>& directory,
                           const Counts& counts) {
  auto& entries = directory.entries();
  const auto n = static_cast<std::size_t>(std::count_if(entries.begin(), entries.end(), counts));
  std::size_t next = ranks.exclusive_scan(n);
  for (Entry& entry : entries)
    if (counts(entry)) entry.number = static_cast<GlobalIndex>(next++);
  return ranks.sum(n);
}

/// Returns the tag of each number.
template <class Entry>
NodeDirectory<std::size_t> tags_by_number(const Ranks& ranks, NodeDirectory<Entry>& directory,
                                          std::size_t n) {
  std::vector<GlobalIndex> numbers;
  std::vector<std::size_t> tags;
  for (std::size_t i = 0; i < directory.entries().size(); ++i)
    if (directory.entries()[i].number != no_number) {
      numbers.push_back(directory.entries()[i].number);
      tags.push_back(directory.first() + i);
    }
  NodeDirectory<std::size_t> result(ranks, n);
  result.give(numbers, tags, [](std::size_t& kept, std::size_t tag, int) { kept = tag; });
  return result;
}

/// Returns the positions of tags among the sorted ones of a rank.
class Positions {
 public:
  explicit Positions(std::vector<GlobalIndex> sorted) : sorted_(std::move(sorted)) {}
  const std::vector<GlobalIndex>& tags() const { return sorted_; }
  std::size_t operator[](GlobalIndex tag) const {
    return static_cast<std::size_t>(std::lower_bound(sorted_.begin(), sorted_.end(), tag) -
                                    sorted_.begin());
  }

 private:
  std::vector<GlobalIndex> sorted_;
};

}  // namespace

MshBlocks::MshBlocks(const Ranks& ranks, const std::filesystem::path& path)
    : ranks_(ranks), path_(path) {
  ranks_.on_root([&] { layout_ = msh_layout(path); });
  std::vector<char> obstacle(layout_.obstacle.begin(), layout_.obstacle.end());
  ranks_.broadcast(obstacle);
  layout_.obstacle.assign(obstacle.begin(), obstacle.end());
  ranks_.broadcast(layout_.nodes);
  ranks_.broadcast(layout_.elements);
  ranks_.broadcast(layout_.last_node);
  ranks_.broadcast(layout_.last_element);
}

template <int dim>
ScatteredMesh<dim> MshBlocks::read_as(ReadFor purpose) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(path_.string() + ": " + what);
  };
  NodeDirectory<TaggedNode> tagged(ranks_, layout_.last_node + 1);
  std::vector<GlobalIndex> tags;
  {
    std::vector<TaggedNode> given;
    ranks_.together([&] {
      const FileParts file(path_);
      for_share(layout_.nodes, ranks_, ranks_.rank(),
                [&](const MshNodeBlock& block, std::uint64_t first, std::uint64_t last) {
                  const auto of_block =
                      file.numbers<std::uint64_t>(block.tags_at + 8 * first, last - first);
                  const auto x = points_of(file, block, first, last);
                  for (std::size_t i = 0; i < of_block.size(); ++i) {
                    tags.push_back(small_tag(path_, of_block[i], layout_.last_node));
                    const double* const point =
                        x.data() + i * static_cast<std::size_t>(block.n_numbers);
                    given.push_back({.x = {point[0], point[1], point[2]}});
                  }
                });
    });
    tagged.give(tags, given, [](TaggedNode& kept, const TaggedNode& node, int) {
      kept.x = node.x;
      ++kept.n_given;
    });
  }
  Elements elements;
  ranks_.together([&] { elements = read_elements<dim>(path_, layout_, ranks_); });
  const Positions corners(std::move(elements.used));
  tagged.name(corners.tags(), [](TaggedNode& node, int) { node.is_used = true; });
  tagged.name(elements.labelled, [](TaggedNode& node, int) { node.is_labelled = true; });
  bool is_wrong = false;
  double least_z = std::numeric_limits<double>::infinity(), most_z = -least_z;
  for (const TaggedNode& node : tagged.entries()) {
    is_wrong |= node.n_given > 1 || (node.is_used && node.n_given == 0);
    if (!node.is_used) continue;
    least_z = std::min(least_z, node.x[2]);
    most_z = std::max(most_z, node.x[2]);
  }
  if (ranks_.any(is_wrong))
    refuse(
        "a node appears twice, or an element names a node that the file does not have; the file is "
        "damaged");
  if (dim == 2 && ranks_.max(most_z) != -ranks_.max(-least_z))
    refuse("a surface mesh cannot be handled in parts; use one file without mpirun");
  const bool keeps_all = purpose == ReadFor::examination;
  const auto counts = [&](const TaggedNode& node) {
    return node.is_used || (keeps_all && node.n_given > 0);
  };
  const std::size_t n_nodes = number_entries(ranks_, tagged, counts);
  ScatteredMesh<dim> mesh{.n_cells = ranks_.sum(elements.cells.size()),
                          .cells = std::move(elements.cells),
                          .nodes = NodeDirectory<NodeEntry<dim>>(ranks_, n_nodes),
                          .is_compact = false};
  {
    std::vector<GlobalIndex> numbers;
    std::vector<NodeEntry<dim>> entries;
    for (const TaggedNode& node : tagged.entries())
      if (counts(node)) {
        numbers.push_back(node.number);
        entries.push_back(
            node_entry<dim>(Point<dim>(node.x.data()),
                            node.is_labelled ? bit(FixedReason::interface) : FixedReasons{0}));
      }
    mesh.nodes.give(numbers, entries,
                    [](NodeEntry<dim>& kept, const NodeEntry<dim>& node, int) { kept = node; });
  }
  const auto number_of = [](const auto& entry) { return entry.number; };
  const auto numbers_of_corners = tagged.ask(corners.tags(), number_of);
  for (GlobalIndex& corner : mesh.cells.corners) corner = numbers_of_corners[corners[corner]];
  numbers_ = tagged.ask(tags, number_of);

  NodeDirectory<TaggedCell> cells(ranks_, layout_.last_element + 1);
  cells.name(mesh.cells.numbers, [](TaggedCell& cell, int) { ++cell.n_given; });
  if (ranks_.any(std::any_of(cells.entries().begin(), cells.entries().end(),
                             [](const TaggedCell& cell) { return cell.n_given > 1; })))
    refuse("an element appears twice; the file is damaged");
  number_entries(ranks_, cells, [](const TaggedCell& cell) { return cell.n_given > 0; });
  mesh.cells.numbers = cells.ask(mesh.cells.numbers, number_of);
  sort_by_numbers(mesh.cells);
  if (keeps_all) {
    mesh.node_ids = tags_by_number(ranks_, tagged, n_nodes);
    mesh.cell_ids = tags_by_number(ranks_, cells, mesh.n_cells);
  }
  return mesh;
}

std::variant<ScatteredMesh<2>, ScatteredMesh<3>> MshBlocks::read(ReadFor purpose) {
  if (std::any_of(layout_.elements.begin(), layout_.elements.end(),
                  [](const MshElementBlock& block) { return block.dimension == 3; }))
    return read_as<3>(purpose);
  return read_as<2>(purpose);
}

template <int dim>
void MshBlocks::write_as(const std::filesystem::path& out,
                         const NodeDirectory<NodeEntry<dim>>& directory) const {
  std::vector<GlobalIndex> used;
  for (const GlobalIndex number : numbers_)
    if (number != no_number) used.push_back(number);
  const auto points = directory.ask(used, [](const NodeEntry<dim>& entry) { return entry.x; });
  std::vector<double> x;  // of this rank's range, as in the file
  ranks_.together([&] {
    const FileParts file(path_);
    std::size_t i = 0, next = 0;
    for_share(layout_.nodes, ranks_, ranks_.rank(),
              [&](const MshNodeBlock& block, std::uint64_t first, std::uint64_t last) {
                auto of_block = points_of(file, block, first, last);
                const auto size = static_cast<std::size_t>(block.n_numbers);
                for (std::size_t at = 0; at < of_block.size(); at += size)
                  if (numbers_[i++] != no_number) {
                    const auto& point = points[next++];
                    std::copy(point.begin(), point.end(),
                              of_block.begin() + static_cast<std::ptrdiff_t>(at));
                  }
                x.insert(x.end(), of_block.begin(), of_block.end());
              });
  });
  std::unique_ptr<AtomicFile> file;
  ranks_.on_root([&] {
    file = std::make_unique<AtomicFile>(out);
    file->copy_from(path_);
  });
  visit_in_turn(ranks_, std::move(x), [&](int rank, const std::vector<double>& numbers) {
    const char* next = reinterpret_cast<const char*>(numbers.data());
    for_share(layout_.nodes, ranks_, rank,
              [&](const MshNodeBlock& block, std::uint64_t first, std::uint64_t last) {
                const auto size = 8 * static_cast<std::uint64_t>(block.n_numbers);
                file->overwrite(block.points_at + first * size, {next, (last - first) * size});
                next += (last - first) * size;
              });
  });
  ranks_.on_root([&] { file->finish(); });
}

}  // namespace smoothfem
