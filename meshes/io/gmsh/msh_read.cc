// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <type_traits>

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

/// Reads the sections of a file. No count is trusted: memory is allocated only for content that the
/// file has.
template <class Input>
class MshReader {
 public:
  /// version: nothing for version 2.
  MshReader(Input input, std::optional<MshVersion4> version)
      : in_(std::move(input)), version_4_(version) {}

  MeshParts parts() {
    in_.require_end("$MeshFormat");
    for (std::string section = in_.next_section(); !section.empty(); section = in_.next_section())
      read(section);
    for (const std::string section : {"$Nodes", "$Elements"})
      if (!seen_.contains(section))
        in_.refuse("the file has no section " + section + "; it is truncated or not a mesh");
    for (int dimension = 1; dimension <= 3; ++dimension) sort(parts_.elements[dimension]);
    parts_.names = groups_.used_names();
    parts_.coordinates = std::move(nodes_.coordinates);
    parts_.node_ids = std::move(nodes_.tags);
    return std::move(parts_);
  }

 private:
  void read(const std::string& section) {
    const bool is_read_once = section == "$Nodes" || section == "$Elements";
    if (!seen_.insert(section).second && is_read_once)
      in_.refuse("there is a second section " + section + "; save the mesh as one");
    if (section == "$PhysicalNames")
      groups_.read_names(in_);
    else if (version_4_ && (section == "$Entities" || section == "$PartitionedEntities"))
      groups_.read_entities(in_, section == "$PartitionedEntities",
                            *version_4_ == MshVersion4::v4_0);
    else if (section == "$Nodes")
      read_nodes();
    else if (section == "$Elements")
      version_4_ ? read_elements_4(*version_4_) : read_elements_2();
    else if (section == "$ParametricNodes")
      in_.refuse("the nodes have parametric coordinates; save the mesh without them");
    else
      return in_.skip_section(section);
    in_.require_end(section);
  }

  void read_nodes() {
    if (!version_4_)
      nodes_.read_2(in_);
    else if (*version_4_ == MshVersion4::v4_0)
      nodes_.read_4_0(in_);
    else
      nodes_.read_4_1(in_);
  }

  const MshElementType& known_type(int number) const {
    if (const auto* type = msh_element_type(number)) return *type;
    in_.refuse(
        "the mesh has elements of Gmsh's type " + std::to_string(number) +
        ", but only points, lines, triangles, quadrilaterals, tetrahedra, hexahedra, prisms "
        "and pyramids without nodes other than their corners can be read; save it with element "
        "order 1");
  }

  void read_elements_2() {
    const std::uint64_t n_elements = msh_count_in_text(in_, "the number of elements");
    for (std::uint64_t i = 0; i < n_elements;) {
      in_.begin("element", i, n_elements);
      if constexpr (std::is_same_v<Input, MshBinaryInput>) {
        const MshElementType& type = known_type(in_.integer("element"));
        const std::uint64_t n = in_.count("the number of elements of a type");
        const std::uint64_t n_tags = in_.count("the number of the element's tags");
        if (n < 1 || n > n_elements - i) in_.fail("a block of elements has a wrong count");
        for (const std::uint64_t end = i + n; i < end; ++i)
          add_element_2(in_.tag("the element's tag"), type, n_tags);
      } else {
        const std::uint64_t tag = in_.tag("the element's tag");
        const MshElementType& type = known_type(in_.integer("element"));
        add_element_2(tag, type, in_.count("the number of the element's tags"));
        ++i;
      }
    }
  }

  void add_element_2(std::uint64_t tag, const MshElementType& type, std::uint64_t n_tags) {
    in_.require_bytes(n_tags, sizeof(std::int32_t));
    int group = 0;
    for (std::uint64_t k = 0; k < n_tags; ++k) {
      const int value = in_.integer("element");
      if (k == 0) group = value;
    }
    groups_.use(type.dimension, group);
    add_element(tag, type, group);
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
      const MshElementType& type = known_type(in_.integer("block"));
      if (dimension != type.dimension)
        in_.fail("the block's entity has dimension " + std::to_string(dimension) +
                 ", its elements have " + std::to_string(type.dimension));
      const std::uint64_t n = in_.count("the number of elements in the block");
      in_.require_bytes(n, (1 + type.n_nodes) * sizeof(std::uint64_t));
      const int group = groups_.tag_of_entity(dimension, entity);
      for (std::uint64_t i = 0; i < n; ++i) {
        in_.begin("element", i, n);
        add_element(in_.tag("the element's tag"), type, group);
      }
      n_found += n;
    }
    msh_require_total(in_, "elements", n_found, n_elements);
  }

  void add_element(std::uint64_t tag, const MshElementType& type, int group) {
    std::array<NodeIndex, 8> nodes{};
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
    if (type.dimension == 0) return;
    ElementList& elements = parts_.elements[static_cast<std::size_t>(type.dimension)];
    elements.nodes.append(std::span(nodes).first(type.n_nodes));
    elements.tags.push_back(group);
    elements.ids.push_back(tag);
    elements.lines.push_back(in_.position());
  }

  void sort(ElementList& elements) {
    const auto order = ascending_order(elements.ids);
    for (std::size_t i = 1; i < order.size(); ++i)
      if (elements.ids[order[i]] == elements.ids[order[i - 1]])
        in_.fail_at(elements.lines[order[i]],
                    "the element tag " + std::to_string(elements.ids[order[i]]) + " appears twice");
    if (!std::is_sorted(elements.ids.begin(), elements.ids.end())) {
      CompressedRows<NodeIndex> nodes;
      for (const std::size_t e : order) nodes.append(elements.nodes[e]);
      elements.nodes = std::move(nodes);
      elements.tags = in_order(elements.tags, order);
      elements.ids = in_order(elements.ids, order);
      elements.lines = in_order(elements.lines, order);
    }
    if constexpr (std::is_same_v<Input, MshBinaryInput>) elements.lines.clear();
  }

  Input in_;
  std::optional<MshVersion4> version_4_;
  std::set<std::string> seen_;
  MshGroups groups_;
  MshNodes nodes_;
  MeshParts parts_;
};

/// Returns nothing for version 2.
std::optional<MshVersion4> version_of(const LineReader& reader, const std::string& word) {
  if (word == "2.2" || word == "2.1" || word == "2.0" || word == "2") return std::nullopt;
  if (word == "4.1") return MshVersion4::v4_1;
  if (word == "4" || word == "4.0") return MshVersion4::v4_0;
  reader.fail("the file has version " + in_quotes(word) + "; save it as version 4.1 or 2.2");
}

}  // namespace

MeshParts read_msh(const std::filesystem::path& path) {
  const std::string content = read_whole_file(path);
  LineReader reader(path, content);
  reader.require_line("the first line");
  if (reader.word() != "$MeshFormat")
    reader.fail("the first line is not '$MeshFormat'; this is not a Gmsh mesh file");
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
  MeshParts parts;
  if (is_binary) {
    MshBinaryInput input(path.string(), content, content.size() - reader.rest().size(),
                         version_4.has_value());
    parts = MshReader(std::move(input), version_4).parts();
  } else {
    parts = MshReader(MshTextInput(reader), version_4).parts();
  }
  parts.leaves_out_unused_nodes = true;
  return parts;
}

namespace {

const RegisteredFormat gmsh_format(
    {.name = "gmsh",
     .extension = ".msh",
     .description = "Gmsh 4.1 and 2.2, text or binary; reads 4.0 as text",
     .holds_planar_meshes = true,
     .holds_volume_meshes = true,
     .holds_surface_meshes = true,
     .holds_physical_names = true,
     .holds_numbers = true,
     .read = read_msh,
     .write = write_msh});

}  // namespace

}  // namespace smoothfem
