// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>

#include "meshes/io/gmsh/msh_data.h"
#include "meshes/io/gmsh/msh_elements.h"
#include "meshes/io/gmsh/msh_file.h"
#include "meshes/io/gmsh/msh_groups.h"
#include "meshes/io/gmsh/msh_input.h"
#include "meshes/io/gmsh/msh_nodes.h"
#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_assembly.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

RepeatedElement repeated_element(const MeshParts& parts, const ElementList& elements,
                                 std::size_t e) {
  RepeatedElement row{.group = elements.tags[e], .id = elements.ids[e]};
  for (const MeshField& field : parts.content.element_fields)
    for (std::size_t k = 0; k < field.n_components; ++k)
      row.values.push_back(field.number(elements.file_positions[e] * field.n_components + k));
  return row;
}

/// Version 2 repeats an element for each of its groups. Joins such elements of one dimension; its
/// entity then has all of the groups. If elements of an entity have different groups, each
/// combination becomes an entity. The numbers and data of the further rows are kept.
void join_repeated_elements(MeshParts& parts) {
  auto& entities = parts.content.entities;
  for (int dimension = 0; dimension <= 3; ++dimension) {
    ElementList& elements = parts.elements[static_cast<std::size_t>(dimension)];
    std::map<std::vector<NodeIndex>, std::size_t> firsts;
    std::map<std::size_t, std::vector<int>> groups;  // of elements that are repeated
    std::vector<std::size_t> kept;
    for (std::size_t e = 0; e < elements.nodes.size(); ++e) {
      std::vector<NodeIndex> nodes(elements.nodes[e].begin(), elements.nodes[e].end());
      std::sort(nodes.begin(), nodes.end());
      const auto [first, is_new] = firsts.emplace(std::move(nodes), e);
      auto& of_first = groups[first->second];
      const bool is_repeated =
          std::find(of_first.begin(), of_first.end(), elements.tags[e]) != of_first.end();
      if (is_new || is_repeated)
        kept.push_back(e);  // a doubled element is refused later
      else
        parts.content.repeated[{dimension, elements.ids[first->second]}].push_back(
            repeated_element(parts, elements, e));
      of_first.push_back(elements.tags[e]);
    }
    if (kept.size() == elements.nodes.size()) continue;
    std::map<std::pair<int, std::vector<int>>, int> numbers;  // of entity and groups
    std::set<int> used(elements.entities.begin(), elements.entities.end());
    std::set<int> divided;
    ElementList joined;
    for (const std::size_t e : kept) {
      const int entity = elements.entities[e];
      const auto& of_element = groups[e];
      const auto [number, is_new] = numbers.try_emplace({entity, of_element}, entity);
      if (is_new && !divided.insert(entity).second) {
        number->second = *used.rbegin() + 1;
        used.insert(number->second);
      }
      if (is_new) entities[{dimension, number->second}].groups = of_element;
      joined.tags.push_back(elements.tags[e]);
      joined.ids.push_back(elements.ids[e]);
      joined.entities.push_back(number->second);
      if (!elements.lines.empty()) joined.lines.push_back(elements.lines[e]);
      if (!elements.file_positions.empty())
        joined.file_positions.push_back(elements.file_positions[e]);
    }
    auto [nodes, midside] = selected_nodes(elements, kept);
    joined.nodes = std::move(nodes);
    joined.midside = std::move(midside);
    elements = std::move(joined);
  }
}

/// Reads the sections of a file. No count is trusted: memory is allocated only for content that the
/// file has.
template <class Input>
class MshReader {
 public:
  /// version: nothing for versions 1 and 2.
  MshReader(Input input, std::optional<MshVersion4> version)
      : in_(std::move(input)), version_4_(version) {}

  /// Reads all sections that follow.
  MeshParts parts() {
    for (std::string section = in_.next_section(); !section.empty(); section = in_.next_section())
      read(section);
    for (const std::string section : {"$Nodes", "$Elements"})
      if (!seen_.contains(section))
        in_.refuse("the file has no section " + section + "; it is truncated or not a mesh");
    for (ElementList& elements : parts_.elements) sort(elements);
    const auto& of = parts_.elements;
    groups_.name_elements({&of[0].tags, &of[1].tags, &of[2].tags, &of[3].tags});
    read_node_fields();
    read_element_fields();
    FileContent& content = parts_.content;
    content.format = "gmsh";
    content.entities = std::move(groups_).entities();
    content.node_entities = std::move(nodes_.entities);
    if (!version_4_) join_repeated_elements(parts_);
    if (has_partitions_)
      parts_.notes.push_back("the division into partitions" +
                             std::string(has_ghosts_ ? " with its ghost elements" : "") +
                             " is left out");
    if (const auto part = groups_.part())
      parts_.notes.push_back("the file has part " + std::to_string(part->number) + " of the " +
                             std::to_string(part->n_all) +
                             " parts of a mesh, and only this part is read" +
                             (version_4_ == MshVersion4::v4_1 && !in_.is_swapped()
                                  ? "; 'smooth', 'quality' and 'check' read all parts if mpirun "
                                    "starts them"
                                  : "; save the mesh as one file"));
    if (partitions_.size() == 1)
      parts_.notes.push_back("all elements are of partition " +
                             std::to_string(*partitions_.begin()) +
                             "; if Gmsh has split the mesh into files, only this one is read");
    if (nodes_.has_parameters)
      parts_.notes.emplace_back("the parametric coordinates of nodes are left out");
    parts_.names = std::move(groups_).names();
    parts_.coordinates = std::move(nodes_.coordinates);
    parts_.node_ids = std::move(nodes_.tags);
    return std::move(parts_);
  }

 private:
  void read(const std::string& section) {
    const bool is_nodes = section == "$Nodes" || section == "$NOD",
               is_elements = section == "$Elements" || section == "$ELM";
    const bool is_new = seen_.insert(is_nodes      ? "$Nodes"
                                     : is_elements ? "$Elements"
                                                   : section)
                            .second;
    if (!is_new && (is_nodes || is_elements))
      in_.refuse("there is a second section " + section + "; save the mesh as one");
    if (section == "$PhysicalNames")
      groups_.read_names(in_);
    else if (version_4_ && (section == "$Entities" || section == "$PartitionedEntities"))
      groups_.read_entities(in_, section == "$PartitionedEntities",
                            *version_4_ == MshVersion4::v4_0);
    else if (is_nodes)
      read_nodes();
    else if (section == "$ELM")
      read_elements_1();
    else if (section == "$Elements")
      version_4_ ? read_elements_4(*version_4_) : read_elements_2();
    else if (section == "$ParametricNodes")
      in_.refuse("the nodes have parametric coordinates; save the mesh without them");
    else if (section == "$Periodic")
      return read_if_sound(section, [&] { read_periodic(); });
    else if (section == "$NodeData")
      return read_if_sound(section, [&] { node_data_.push_back(read_msh_data(in_)); });
    else if (section == "$ElementData")
      return read_if_sound(section, [&] { element_data_.push_back(read_msh_data(in_)); });
    else if (section == "$GhostElements")
      return leave_out_ghosts();
    else
      return keep_section(section);
    in_.require_end(section);
    has_partitions_ = has_partitions_ || section == "$PartitionedEntities";
  }

  /// Ghost elements name partitions, which are left out.
  void leave_out_ghosts() {
    in_.skip_section("$GhostElements");
    has_partitions_ = has_ghosts_ = true;
  }

  /// Reads a section that the mesh does not need. If it is damaged, it is left out with a note.
  template <class Read>
  void read_if_sound(const std::string& section, const Read& read) {
    const Input begin = in_;
    try {
      read();
      in_.require_end(section);
    } catch (const InputError& error) {
      in_ = begin;
      in_.skip_section(section);
      parts_.notes.push_back("the section " + section + " is left out: " + error.what());
    }
  }

  /// Keeps the text of a section that depends on no other one.
  void keep_section(const std::string& section) {
    std::string text = in_.skip_section(section);
    if (in_.is_swapped())
      parts_.notes.push_back("the section " + section + " is left out: it has another byte order");
    else
      keep_text(section, std::move(text));
  }

  void keep_text(const std::string& section, std::string text) {
    parts_.content.sections.push_back(std::move(text));
    parts_.content.section_names.push_back("the section " + section);
  }

  void read_periodic() {
    if (!seen_.contains("$Nodes")) in_.refuse("the section $Periodic comes before $Nodes");
    const auto index_of = [&](std::uint64_t tag) { return nodes_.index_of(tag); };
    auto links = version_4_ == MshVersion4::v4_1 ? read_msh_periodic_4_1(in_, index_of)
                                                 : read_msh_periodic_2(in_, index_of);
    auto& all = parts_.content.periodic;
    all.insert(all.end(), std::make_move_iterator(links.begin()),
               std::make_move_iterator(links.end()));
  }

  void read_node_fields() {
    std::map<std::uint64_t, std::size_t> positions;
    if (!node_data_.empty())
      for (std::size_t i = 0; i < nodes_.tags.size(); ++i) positions[nodes_.tags[i]] = i;
    for (MshData& data : node_data_)
      parts_.content.node_fields.push_back(
          field_of(std::move(data), nodes_.tags.size(), positions));
  }

  /// Gives the rows of element data the order of the elements.
  void read_element_fields() {
    if (element_data_.empty()) return;
    std::map<std::uint64_t, std::size_t> positions;
    std::uint32_t n = 0;
    for (int dimension = 3; dimension >= 0; --dimension) {
      ElementList& elements = parts_.elements[static_cast<std::size_t>(dimension)];
      for (const std::size_t id : elements.ids) {
        positions[id] = n;
        elements.file_positions.push_back(n++);
      }
    }
    for (MshData& data : element_data_)
      parts_.content.element_fields.push_back(field_of(std::move(data), n, positions));
  }

  void read_nodes() {
    if (!version_4_)
      nodes_.read_2(in_);
    else if (*version_4_ == MshVersion4::v4_0)
      nodes_.read_4_0(in_);
    else
      nodes_.read_4_1(in_);
  }

  MshType known_type(int number) const {
    if (const MshType type = msh_type(number); type.number != 0) return type;
    in_.refuse(
        "the mesh has elements of Gmsh's type " + std::to_string(number) +
        ", but only points and lines, triangles, quadrilaterals, tetrahedra, hexahedra, "
        "prisms and pyramids of order 1 or 2 can be read; save it with element order 1 or 2");
  }

  void read_elements_1() {
    const std::uint64_t n_elements = msh_count_in_text(in_, "the number of elements");
    for (std::uint64_t i = 0; i < n_elements; ++i) {
      in_.begin("element", i, n_elements);
      const std::uint64_t tag = in_.tag("the element's tag");
      const MshType& type = known_type(in_.integer("element"));
      const int group = in_.integer("element"), entity = in_.integer("element");
      if (in_.count("the number of nodes") != type.n_nodes)
        in_.fail("element " + std::to_string(tag) + " has another number of nodes than its type");
      add_element(tag, type, group, entity);
    }
  }

  void read_elements_2() {
    const std::uint64_t n_elements = msh_count_in_text(in_, "the number of elements");
    for (std::uint64_t i = 0; i < n_elements;) {
      in_.begin("element", i, n_elements);
      if constexpr (std::is_same_v<Input, MshBinaryInput>) {
        const MshType& type = known_type(in_.integer("element"));
        const std::uint64_t n = in_.count("the number of elements of a type");
        const std::uint64_t n_tags = in_.count("the number of the element's tags");
        if (n < 1 || n > n_elements - i) in_.fail("a block of elements has a wrong count");
        for (const std::uint64_t end = i + n; i < end; ++i)
          add_element_2(in_.tag("the element's tag"), type, n_tags);
      } else {
        const std::uint64_t tag = in_.tag("the element's tag");
        const MshType& type = known_type(in_.integer("element"));
        add_element_2(tag, type, in_.count("the number of the element's tags"));
        ++i;
      }
    }
  }

  void add_element_2(std::uint64_t tag, const MshType& type, std::uint64_t n_tags) {
    in_.require_bytes(n_tags, sizeof(std::int32_t));
    int group = 0, entity = 0;
    for (std::uint64_t k = 0; k < n_tags; ++k) {
      const int value = in_.integer("element");
      if (k == 0) group = value;
      if (k == 1) entity = value;
      has_partitions_ = has_partitions_ || (k > 1 && value != 0);
      if (k == 3) partitions_.insert(value);
    }
    add_element(tag, type, group, entity);
  }

  void read_elements_4(MshVersion4 version) {
    in_.begin("the numbers of elements");
    const std::uint64_t n_blocks = in_.count("the number of element blocks");
    const std::uint64_t n_elements = in_.count("the number of elements");
    msh_end_of_totals(in_, version);
    std::uint64_t n_found = 0;
    for (std::uint64_t b = 0; b < n_blocks; ++b) {
      in_.begin("element block", b, n_blocks);
      const auto [dimension, entity] = msh_entity_of_block(in_, version);
      const MshType& type = known_type(in_.integer("block"));
      if (dimension != type.dimension)
        in_.fail("the block's entity has dimension " + std::to_string(dimension) +
                 ", its elements have " + std::to_string(type.dimension));
      const std::uint64_t n = in_.count("the number of elements in the block");
      in_.require_bytes(n, (1 + type.n_nodes) * sizeof(std::uint64_t));
      const int group = groups_.tag_of_entity(dimension, entity);
      const bool are_ghosts = groups_.has_ghosts(dimension, entity);
      for (std::uint64_t i = 0; i < n; ++i) {
        in_.begin("element", i, n);
        if (are_ghosts)
          skip_element(type);
        else
          add_element(in_.tag("the element's tag"), type, group, entity);
      }
      n_found += n;
    }
    msh_require_total(in_, "elements", n_found, n_elements);
  }

  /// Copies of elements of other partitions.
  void skip_element(const MshType& type) {
    in_.tag("the element's tag");
    for (std::size_t k = 0; k < type.n_nodes; ++k) in_.node_of_element();
    in_.end();
    has_ghosts_ = true;
  }

  void add_element(std::uint64_t tag, const MshType& type, int group, int entity) {
    std::array<NodeIndex, 27> nodes{};
    for (std::size_t k = 0; k < type.n_nodes; ++k) {
      if (!in_.has_value())
        in_.fail("element " + std::to_string(tag) + " has " + std::to_string(k) +
                 " nodes, but those of Gmsh's type " + std::to_string(type.number) + " have " +
                 std::to_string(type.n_nodes));
      const std::int64_t node = in_.node_of_element();
      const auto index = nodes_.index_of(static_cast<std::uint64_t>(node));
      if (!index)
        in_.fail("element " + std::to_string(tag) + " names node " + std::to_string(node) +
                 ", which the file does not have");
      nodes[k] = *index;
    }
    in_.end();
    ElementList& elements = parts_.elements[static_cast<std::size_t>(type.dimension)];
    const std::span row(nodes.data(), type.n_nodes);
    if (type.order) type.order->from_file(row);
    elements.append_nodes(row, type.n_corners);
    elements.tags.push_back(group);
    elements.ids.push_back(tag);
    elements.entities.push_back(entity);
    elements.lines.push_back(in_.position());
  }

  void sort(ElementList& elements) {
    const auto order = ascending_order(elements.ids);
    for (std::size_t i = 1; i < order.size(); ++i)
      if (elements.ids[order[i]] == elements.ids[order[i - 1]])
        in_.fail_at(elements.lines[order[i]],
                    "the element tag " + std::to_string(elements.ids[order[i]]) + " appears twice");
    if (!std::is_sorted(elements.ids.begin(), elements.ids.end())) {
      auto [nodes, midside] = selected_nodes(elements, order);
      elements.nodes = std::move(nodes);
      elements.midside = std::move(midside);
      elements.tags = in_order(elements.tags, order);
      elements.entities = in_order(elements.entities, order);
      elements.ids = in_order(elements.ids, order);
      elements.lines = in_order(elements.lines, order);
    }
    if constexpr (std::is_same_v<Input, MshBinaryInput>) elements.lines.clear();
  }

  Input in_;
  std::optional<MshVersion4> version_4_;
  std::set<std::string> seen_;
  std::vector<MshData> node_data_, element_data_;
  bool has_partitions_ = false, has_ghosts_ = false;
  std::set<int> partitions_;  ///< the first ones of elements, in version 2
  MshGroups groups_;
  MshNodes nodes_;
  MeshParts parts_;
};

constexpr std::string_view msh_first_line = "$MeshFormat", msh_first_line_1 = "$NOD",
                           msh_comments = "$Comments";

bool is_msh(std::string_view beginning) {
  LineReader reader({}, beginning);
  if (!reader.next_line()) return false;
  const std::string_view word = reader.word();
  return word == msh_first_line || word == msh_first_line_1 || word == msh_comments;
}

/// Reads comments before the first line that the format asks for. Returns their sections.
std::vector<std::string> leading_comments(LineReader& reader) {
  std::vector<std::string> comments;
  reader.require_line("the first line");
  while (reader.text().starts_with(msh_comments)) {
    MshTextInput input(reader);
    comments.push_back(input.skip_section(std::string(msh_comments)));
    reader = input.reader();
    reader.require_line("the format's version");
  }
  return comments;
}

/// Reads version 1, which is text and has no section with its version.
MeshParts read_msh_1(const std::filesystem::path& path, std::string_view content) {
  MeshParts parts = MshReader(MshTextInput(LineReader(path, content)), std::nullopt).parts();
  parts.content.version = "2.2";
  parts.leaves_out_unused_nodes = true;
  parts.notes.emplace_back(
      "the file has version 1 of Gmsh's format; .msh files are written in 2.2");
  return parts;
}

/// Returns nothing for version 2.
std::optional<MshVersion4> version_of(const LineReader& reader, const std::string& word) {
  const std::size_t last = word.find_last_not_of('0');  // of 2.200000
  const std::string version = word.find('.') == word.npos ? word + "." : word.substr(0, last + 1);
  if (version == "2.2" || version == "2.1" || version == "2.") return std::nullopt;
  if (version == "4.1") return MshVersion4::v4_1;
  if (version == "4.") return MshVersion4::v4_0;
  reader.fail("the file has version " + in_quotes(word) + "; save it as version 4.1 or 2.2");
}

}  // namespace

namespace {

/// What the first section of a file of version 2 or later says.
struct MshHead {
  std::optional<MshVersion4> version;
  bool is_binary;
};

/// Reads the rest of the first section, after its first line. Throws InputError.
MshHead read_head(LineReader& reader) {
  reader.require_line("the format's version");
  const std::string word(reader.word());
  const std::optional<MshVersion4> version_4 = version_of(reader, word);
  const bool is_binary = reader.integer("the file type", 2) == 1;
  const std::uint64_t size = reader.integer("the size of numbers");
  if (is_binary && size != sizeof(double))
    reader.fail("the file's numbers have " + std::to_string(size) +
                " bytes instead of 8; save it as text");
  // Gmsh neither writes nor reads such files.
  if (is_binary && version_4 == MshVersion4::v4_0)
    reader.fail("the file has version " + in_quotes(word) +
                " and is binary; save it as text, or as version 4.1 or 2.2");
  return {version_4, is_binary};
}

/// Returns visit(input) after the first section.
template <class Visit>
auto with_input(const std::filesystem::path& path, std::string_view content,
                const LineReader& reader, const MshHead& head, const Visit& visit) {
  if (head.is_binary) {
    MshBinaryInput input(path.string(), content, content.size() - reader.rest().size(),
                         head.version.has_value());
    input.require_end("$MeshFormat");
    return visit(std::move(input));
  }
  MshTextInput input(reader);
  input.require_end("$MeshFormat");
  return visit(std::move(input));
}

/// Returns the beginning of a file up to the end of $PartitionedEntities; nothing if there is no
/// such section before the nodes.
std::string beginning_with_partitions(const std::filesystem::path& path) {
  constexpr std::string_view end = "$EndPartitionedEntities";
  std::ifstream file(path, std::ios::binary);
  std::string content;
  for (std::string chunk(std::size_t{1} << 16, '\0'); file;) {
    file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    const std::size_t from = content.size() - std::min(content.size(), end.size());
    content.append(chunk, 0, static_cast<std::size_t>(file.gcount()));
    if (const std::size_t at = content.find(end, from); at != content.npos)
      return content.substr(0, at + end.size());
    if (!content.starts_with('$') || content.find("\n$Nodes", from) != content.npos) break;
  }
  return {};
}

}  // namespace

std::optional<MshPart> msh_part(const std::filesystem::path& path) {
  try {
    const std::string content = beginning_with_partitions(path);
    if (content.empty()) return std::nullopt;
    LineReader reader(path, content);
    (void)leading_comments(reader);
    if (reader.word() != msh_first_line) return std::nullopt;
    const MshHead head = read_head(reader);
    if (head.version != MshVersion4::v4_1) return std::nullopt;
    return with_input(path, content, reader, head, [](auto input) -> std::optional<MshPart> {
      MshGroups groups;
      for (std::string section = input.next_section(); !section.empty() && !input.is_swapped();
           section = input.next_section()) {
        const bool is_partitioned = section == "$PartitionedEntities";
        if (is_partitioned || section == "$Entities")
          groups.read_entities(input, is_partitioned, false);
        else
          input.skip_section(section);
        if (is_partitioned) return groups.part();
        if (section == "$Entities") input.require_end(section);
      }
      return std::nullopt;
    });
  } catch (const InputError&) {
    return std::nullopt;
  }
}

MeshParts read_msh(const std::filesystem::path& path, const MeshReadOptions&) {
  const std::string content = read_whole_file(path);
  LineReader reader(path, content);
  auto comments = leading_comments(reader);
  const std::string_view first = reader.word();
  if (first == msh_first_line_1) return read_msh_1(path, content);
  if (first != msh_first_line)
    reader.fail("the first line is not '$MeshFormat'; this is not a Gmsh mesh file");
  const MshHead head = read_head(reader);
  MeshParts parts = with_input(path, content, reader, head, [&](auto input) {
    return MshReader(std::move(input), head.version).parts();
  });
  for (std::string& section : comments) {
    parts.content.sections.push_back(std::move(section));
    parts.content.section_names.push_back("the section " + std::string(msh_comments));
  }
  parts.content.version = head.version ? "4.1" : "2.2";
  parts.content.is_binary = head.is_binary;
  parts.leaves_out_unused_nodes = true;
  return parts;
}

namespace {

const RegisteredFormat gmsh_format(
    {.name = "gmsh",
     .extension = ".msh",
     .description = "Gmsh 4.1 and 2.2, text or binary; reads 1 and 4.0 as text",
     .holds_planar_meshes = true,
     .holds_volume_meshes = true,
     .holds_surface_meshes = true,
     .holds_second_order = true,
     .holds_facets = true,
     .holds_physical_names = true,
     .holds_numbers = true,
     .holds_several_groups = true,
     .holds_periodic = true,
     .has_two_encodings = true,
     .min_element_dimension = 0,
     .holds_field =
         [](const MeshField& field, bool is_of_file) {
           return !is_of_file && msh_components(field.n_components) > 0;
         },
     .recognizes = is_msh,
     .read = read_msh,
     .write = write_msh});

}  // namespace

}  // namespace smoothfem
