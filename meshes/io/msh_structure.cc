#include <charconv>
#include <string>
#include <unordered_set>

#include "meshes/io/line_reader.h"
#include "meshes/io/msh_file.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

/// Walks through a text file. Sections other than nodes and elements are only looked at for their
/// end.
class MshScanner {
 public:
  MshScanner(LineReader& reader, bool version_4, MshStructure& structure)
      : reader_(reader), version_4_(version_4), structure_(structure) {}

  void scan() {
    bool has_nodes = false, has_elements = false;
    while (reader_.next_line()) {
      const std::string section(reader_.word());
      if (section.front() != '$' || section.starts_with("$End"))
        reader_.fail(
            "expected the beginning of a section; a section before has more lines than "
            "announced");
      if (section == "$Nodes") {
        version_4_ ? scan_nodes_4() : scan_nodes_2();
        has_nodes = true;
      } else if (section == "$Elements") {
        version_4_ ? scan_elements_4() : scan_elements_2();
        has_elements = true;
      } else {
        skip_to_end(section);
        continue;
      }
      require_end(section);
    }
    if (!has_nodes || !has_elements)
      reader_.fail(std::string("the file has no section ") + (has_nodes ? "$Elements" : "$Nodes") +
                   "; it is truncated or holds no mesh");
  }

 private:
  static std::string end_of(const std::string& section) { return "$End" + section.substr(1); }

  void skip_to_end(const std::string& section) {
    do reader_.require_line(end_of(section));
    while (!reader_.text().starts_with(end_of(section)));
  }

  void require_end(const std::string& section) {
    reader_.require_line(end_of(section));
    if (reader_.word() != end_of(section))
      reader_.fail("expected " + end_of(section) + "; the section has more lines than announced");
  }

  void scan_point(const std::string& what) {
    for (const char* axis : {"x", "y", "z"}) reader_.number(what + "'s " + axis + " coordinate");
  }

  void scan_node_tag() {
    const std::uint64_t tag = reader_.integer("the node's tag");
    if (!node_tags_.insert(tag).second)
      reader_.fail("the node tag " + std::to_string(tag) + " appears twice");
  }

  void scan_nodes_2() {
    reader_.require_line("the number of nodes");
    const std::uint64_t n_nodes = reader_.integer("the number of nodes");
    for (std::uint64_t i = 0; i < n_nodes; ++i) {
      reader_.require_line("node " + std::to_string(i + 1) + " of " + std::to_string(n_nodes));
      scan_node_tag();
      scan_point("the node");
      reader_.require_end_of_line();
    }
  }

  void scan_nodes_4() {
    reader_.require_line("the numbers of nodes");
    const std::uint64_t n_blocks = reader_.integer("the number of node blocks");
    const std::uint64_t n_nodes = reader_.integer("the number of nodes");
    std::uint64_t n_found = 0;
    for (std::uint64_t b = 0; b < n_blocks; ++b) {
      reader_.require_line("node block " + std::to_string(b + 1) + " of " +
                           std::to_string(n_blocks));
      for (const char* what : {"the entity's dimension", "the entity's tag", "'parametric'"})
        reader_.integer(what);
      const std::uint64_t n = reader_.integer("the number of nodes in the block");
      n_found += n;
      for (std::uint64_t i = 0; i < n; ++i) {
        reader_.require_line("the tags of " + std::to_string(n) + " nodes");
        scan_node_tag();
        reader_.require_end_of_line();
      }
      for (std::uint64_t i = 0; i < n; ++i) {
        reader_.require_line("the coordinates of " + std::to_string(n) + " nodes");
        scan_point("the node");  // parametric coordinates may follow
      }
    }
    require_total("nodes", n_found, n_nodes);
  }

  void scan_elements_2() {
    reader_.require_line("the number of elements");
    structure_.n_elements = reader_.integer("the number of elements");
    for (std::uint64_t i = 0; i < structure_.n_elements; ++i) {
      reader_.require_line("element " + std::to_string(i + 1) + " of " +
                           std::to_string(structure_.n_elements));
      scan_element();
    }
  }

  void scan_elements_4() {
    reader_.require_line("the numbers of elements");
    const std::uint64_t n_blocks = reader_.integer("the number of element blocks");
    structure_.n_elements = reader_.integer("the number of elements");
    std::uint64_t n_found = 0;
    for (std::uint64_t b = 0; b < n_blocks; ++b) {
      reader_.require_line("element block " + std::to_string(b + 1) + " of " +
                           std::to_string(n_blocks));
      for (const char* what : {"the entity's dimension", "the entity's tag", "the element type"})
        reader_.integer(what);
      const std::uint64_t n = reader_.integer("the number of elements in the block");
      n_found += n;
      for (std::uint64_t i = 0; i < n; ++i) {
        reader_.require_line("element " + std::to_string(i + 1) + " of " + std::to_string(n) +
                             " in the block");
        scan_element();
      }
    }
    require_total("elements", n_found, structure_.n_elements);
  }

  void scan_element() {
    const std::uint64_t tag = reader_.integer("the element's tag");
    structure_.element_lines.emplace(tag, reader_.line());
    if (!version_4_) {
      reader_.integer("the element's type");
      const std::uint64_t n_tags = reader_.integer("the number of the element's tags");
      for (std::uint64_t i = 0; i < n_tags; ++i) scan_integer(reader_.word());
    }
    for (std::string_view word = reader_.word(); !word.empty(); word = reader_.word()) {
      const long node = scan_integer(word);
      if (!node_tags_.contains(static_cast<std::uint64_t>(node)))
        reader_.fail("element " + std::to_string(tag) + " names node " + std::to_string(node) +
                     ", which the file does not have");
    }
  }

  /// Tags may be negative.
  long scan_integer(std::string_view word) {
    long value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || word.empty())
      reader_.fail("the element's line holds '" + std::string(word.substr(0, 40)) +
                   "', which is not an integer");
    return value;
  }

  void require_total(const std::string& what, std::uint64_t n_found, std::uint64_t n_announced) {
    if (n_found != n_announced)
      reader_.fail("the section announces " + std::to_string(n_announced) + " " + what +
                   " but has " + std::to_string(n_found));
  }

  LineReader& reader_;
  bool version_4_;
  MshStructure& structure_;
  std::unordered_set<std::uint64_t> node_tags_;
};

}  // namespace

MshStructure check_msh_structure(const std::filesystem::path& path, std::string_view content) {
  LineReader reader(path, content);
  reader.require_line("the first line");
  if (reader.word() != "$MeshFormat")
    reader.fail("the first line is not '$MeshFormat'; this is not a Gmsh mesh file");
  reader.require_line("the format's version");
  const std::string version(reader.word());
  const bool version_4 = version == "4.1";
  if (!version_4 && version != "2.2" && version != "2.1" && version != "2" && version != "2.0")
    reader.fail("the file has version '" + version.substr(0, 40) +
                "'; save it as version 4.1 or 2.2");
  MshStructure structure;
  structure.binary = reader.integer("the file type", 2) == 1;
  if (structure.binary) {
    structure.n_elements = check_binary_msh(path, content, version_4);
    return structure;
  }
  reader.require_line("$EndMeshFormat");
  if (reader.word() != "$EndMeshFormat") reader.fail("expected $EndMeshFormat");
  MshScanner(reader, version_4, structure).scan();
  return structure;
}

}  // namespace smoothfem
