// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/text/medit_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>

#include "meshes/io/atomic_file.h"
#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_assembly.h"
#include "smoothing/base/input_error.h"
#include "smoothing/base/text.h"

namespace smoothfem {

namespace {

constexpr std::string_view title = "MeshVersionFormatted";

/// The sections with elements, in the order in which they are written.
struct Section {
  std::string_view keyword;
  int dimension;
  std::size_t n_nodes;
};
constexpr std::array sections{Section{"Tetrahedra", 3, 4}, Section{"Hexahedra", 3, 8},
                              Section{"Prisms", 3, 6},     Section{"Pyramids", 3, 5},
                              Section{"Triangles", 2, 3},  Section{"Quadrilaterals", 2, 4},
                              Section{"Edges", 1, 2}};

/// The numbers of a skipped section; the number of words in an entry is unknown.
class SkippedSection {
 public:
  void add(std::string_view word) {
    if (n_words_++ == 0) std::from_chars(word.data(), word.data() + word.size(), n_entries_);
  }
  bool is_complete() const {
    return n_words_ > 0 &&
           (n_entries_ == 0 ? n_words_ == 1 : n_words_ > 1 && (n_words_ - 1) % n_entries_ == 0);
  }

 private:
  std::uint64_t n_words_ = 0,
                n_entries_ = 0;  ///< the first word is the number of entries that follow
};

class MeditReader {
 public:
  MeditReader(const std::filesystem::path& path, std::string_view content)
      : reader_(path, content), content_(content) {}

  MeshParts parts() {
    if (word("the first word") != title)
      reader_.fail("the first word is not '" + std::string(title) + "'");
    integer("the version");
    for (auto keyword = next_keyword(); !keyword.empty(); keyword = next_keyword())
      if (keyword != "End")
        read_section(keyword);
      else if (!section_follows())
        break;
    return std::move(parts_);
  }

 private:
  std::string_view word(std::string_view what) {
    reader_.require_word(what, '#');
    return reader_.word();
  }
  std::uint64_t integer(std::string_view what, std::uint64_t limit = UINT64_MAX) {
    reader_.require_word(what, '#');
    return reader_.integer(what, limit);
  }
  double number(std::string_view what) {
    reader_.require_word(what, '#');
    return reader_.number(what);
  }

  static const Section* find_section(std::string_view keyword) {
    const auto* section = std::find_if(sections.begin(), sections.end(),
                                       [&](const Section& s) { return s.keyword == keyword; });
    return section == sections.end() ? nullptr : section;
  }

  /// True if a section follows. Some programs write 'End' after each section; anything else after
  /// it is not read.
  bool section_follows() const {
    LineReader ahead = reader_;
    return ahead.find_word('#') && find_section(ahead.word()) != nullptr;
  }

  void read_section(std::string_view keyword) {
    if (const Section* section = find_section(keyword)) {
      read_elements(*section);
    } else if (keyword == "Dimension") {
      dimension_ = integer("the dimension", 4);
      if (dimension_ < 2) reader_.fail("the dimension must be 2 or 3");
    } else if (keyword == "Vertices") {
      read_vertices();
    } else if (keyword == "RequiredVertices") {
      read_required();
    } else if (keyword.ends_with("P2") || keyword.ends_with("Q2")) {
      reader_.fail("the section " + std::string(keyword) +
                   " has elements with nodes other than their corners; save the mesh with linear "
                   "elements");
    } else {
      skipped_.emplace();
    }
  }

  /// Returns the next keyword, or nothing at the end of the file. Entries of skipped sections are
  /// not keywords, as they do not begin with a letter.
  std::string_view next_keyword() {
    while (reader_.find_word('#')) {
      const std::string_view found = reader_.word();
      if (std::isalpha(static_cast<unsigned char>(found.front()))) {
        skipped_.reset();
        return found;
      }
      if (!skipped_)
        reader_.fail("expected the name of a section, but found " + in_quotes(found) +
                     "; the previous section has more entries than announced");
      skipped_->add(found);
    }
    require_complete();
    return {};
  }

  /// Checks that the file is complete. Not every program writes 'End'; a file without it may have
  /// been cut off within a number or a skipped section.
  void require_complete() const {
    if (!content_.ends_with('\n') || (skipped_ && !skipped_->is_complete()))
      reader_.fail(
          "the file ends before the last word, 'End', and not after a section; it is "
          "truncated");
  }

  /// Reads a count. It cannot exceed the remaining bytes, so that a wrong one is found before
  /// memory is allocated.
  std::size_t count(std::string_view keyword) {
    const std::uint64_t n = integer("the number of " + std::string(keyword));
    if (n > reader_.rest().size())
      reader_.fail("the section " + std::string(keyword) + " announces " + std::to_string(n) +
                   " entries, more than the file has; it is truncated or the count is wrong");
    return n;
  }

  void read_vertices() {
    if (dimension_ == 0) reader_.fail("the section Vertices comes before the dimension");
    if (!parts_.coordinates.empty()) reader_.fail("there is a second section Vertices");
    const std::size_t n = count("Vertices");
    parts_.coordinates.assign(n, Point<3>::Zero());
    for (auto& point : parts_.coordinates) {
      for (std::uint64_t d = 0; d < dimension_; ++d)
        point[static_cast<Eigen::Index>(d)] = number("a coordinate");
      word("the vertex's reference");
    }
  }

  void require_vertices(std::string_view section) const {
    if (parts_.coordinates.empty())
      reader_.fail("the section " + std::string(section) + " comes before Vertices");
  }

  NodeIndex node() {
    const std::uint64_t number = integer("the node", parts_.coordinates.size() + 1);
    if (number == 0) reader_.fail("the node is 0, but nodes are counted from 1");
    return static_cast<NodeIndex>(number - 1);
  }

  void read_elements(const Section& section) {
    const std::size_t n = count(section.keyword);
    require_vertices(section.keyword);
    ElementList& elements = parts_.elements[section.dimension];
    std::array<NodeIndex, 8> nodes{};
    for (std::size_t e = 0; e < n; ++e) {
      for (std::size_t k = 0; k < section.n_nodes; ++k) {
        nodes[k] = node();
        if (k == 0) elements.lines.push_back(reader_.line());
      }
      elements.nodes.append(std::span(nodes).first(section.n_nodes));
      elements.tags.push_back(reference());
    }
  }

  /// Some programs use references beyond the integers for "none".
  int reference() {
    const double value = number("the reference");
    return std::abs(value) <= std::numeric_limits<int>::max() ? static_cast<int>(value) : 0;
  }

  void read_required() {
    require_vertices("RequiredVertices");
    if (!parts_.fixed) parts_.fixed.emplace(parts_.coordinates.size(), false);
    parts_.fixes_boundary_as_well = true;
    for (std::size_t n = count("RequiredVertices"); n > 0; --n) (*parts_.fixed)[node()] = true;
  }

  LineReader reader_;
  std::string_view content_;
  std::uint64_t dimension_ = 0;
  std::optional<SkippedSection> skipped_;  ///< the current section
  MeshParts parts_;
};

}  // namespace

bool is_medit_text(std::string_view content) {
  LineReader reader({}, content);
  return reader.next_line() && reader.word() == title;
}

MeshParts read_medit_text(const std::filesystem::path& path) {
  const std::string content = read_whole_file(path);
  return MeditReader(path, content).parts();
}

namespace {

void append_row(std::string& text, std::span<const NodeIndex> nodes, int reference) {
  for (const NodeIndex node : nodes) {
    append_number(text, std::size_t{node} + 1);
    text += ' ';
  }
  append_number(text, reference);
  text += '\n';
}

void append_section(std::string& text, const Section& section,
                    const CompressedRows<NodeIndex>& rows, const std::vector<int>& tags) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) n += rows[i].size() == section.n_nodes;
  if (n == 0) return;
  text.append(section.keyword).append("\n").append(std::to_string(n)).append("\n");
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].size() == section.n_nodes) append_row(text, rows[i], tags.empty() ? 0 : tags[i]);
}

struct Facets {
  CompressedRows<NodeIndex> nodes;
  std::vector<int> tags;
};

std::vector<NodeIndex> sorted(std::span<const NodeIndex> nodes) {
  std::vector<NodeIndex> key(nodes.begin(), nodes.end());
  std::sort(key.begin(), key.end());
  return key;
}

/// Returns the labelled facets, and those of the boundary without a label with reference 0.
Facets facets_with_boundary(const Topology& topology) {
  Facets facets{topology.labels().facets, topology.labels().facet_tags};
  std::set<std::vector<NodeIndex>> labelled;
  for (std::size_t f = 0; f < facets.nodes.size(); ++f) labelled.insert(sorted(facets.nodes[f]));
  const auto& boundary = topology.boundary_facets();
  for (std::size_t f = 0; f < boundary.size(); ++f) {
    if (labelled.contains(sorted(boundary[f]))) continue;
    facets.nodes.append(boundary[f]);
    facets.tags.push_back(0);
  }
  return facets;
}

void write(const std::filesystem::path& path, const MeshView& mesh,
           const CompressedRows<NodeIndex>& facets, const std::vector<int>& facet_tags) {
  const Topology& topology = mesh.topology();
  const int space_dimension = mesh.planar() != nullptr ? 2 : 3;
  std::string text(title);
  text += " 2\nDimension " + std::to_string(space_dimension) + "\nVertices\n" +
          std::to_string(mesh.n_nodes()) + "\n";
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    const Point<3> point = mesh.point(i);
    for (int d = 0; d < space_dimension; ++d) {
      append_number(text, point[d]);
      text += ' ';
    }
    text += "0\n";
  }
  for (const Section& section : sections) {
    if (section.dimension == mesh.dimension())
      append_section(text, section, topology.cells(), topology.labels().cell_tags);
    else if (section.dimension == mesh.dimension() - 1)
      append_section(text, section, facets, facet_tags);
  }
  text += "RequiredVertices\n" + std::to_string(mesh.n_nodes() - topology.free_nodes().size());
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    if (topology.is_fixed(i)) text += "\n" + std::to_string(i + 1);
  text += "\nEnd\n";
  write_atomically(path, text);
}

}  // namespace

void write_medit_text(const std::filesystem::path& path, const MeshView& mesh, const MeshFields&,
                      const MeshWriteOptions&) {
  const MeshLabels& labels = mesh.topology().labels();
  write(path, mesh, labels.facets, labels.facet_tags);
}

void write_medit_with_boundary(const std::filesystem::path& path, const MeshView& mesh) {
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    if (mesh.topology().cell_type(c) == ElementType::polygon)
      throw InputError(
          "cannot write " + path.string() + ": cell " + std::to_string(c) + " has " +
          std::to_string(mesh.topology().cell_nodes(c).size()) +
          " nodes, but Medit's cells of planar meshes have three or four; use the format "
          "vtk or mesh");
  const Facets facets = facets_with_boundary(mesh.topology());
  write(path, mesh, facets.nodes, facets.tags);
}

namespace {

const RegisteredFormat medit({.name = "medit",
                              .extension = ".mesh",
                              .description = "Medit, text; written for volume meshes",
                              .holds_volume_meshes = true,
                              .recognizes = is_medit_text,
                              .read = read_medit_text,
                              .write = write_medit_text});

}  // namespace

}  // namespace smoothfem
