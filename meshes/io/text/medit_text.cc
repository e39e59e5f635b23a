// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/text/medit_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>

#include "meshes/io/all_elements.h"
#include "meshes/io/atomic_file.h"
#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/io/node_order.h"
#include "meshes/io/text/medit_solution.h"
#include "smoothing/base/input_error.h"
#include "smoothing/base/text.h"
#include "smoothing/mesh/interfaces.h"
#include "smoothing/mesh/sorted_nodes.h"

namespace smoothfem {

namespace {

constexpr std::string_view medit_title = "MeshVersionFormatted",
                           medit_reference_field = "reference";

/// The sections with elements, in the order in which they are written. Elements of second order
/// list their corners and then the nodes of edges, as VTK does.
struct Section {
  std::string_view keyword;
  int dimension;
  std::size_t n_corners;
  const NodeOrder* order = nullptr;  ///< null: linear elements

  std::size_t n_nodes() const { return order ? order->size : n_corners; }
};
constexpr std::array sections{Section{"Tetrahedra", 3, 4},
                              Section{"Hexahedra", 3, 8},
                              Section{"Prisms", 3, 6},
                              Section{"Pyramids", 3, 5},
                              Section{"TetrahedraP2", 3, 4, &tetrahedron_10},
                              Section{"Triangles", 2, 3},
                              Section{"Quadrilaterals", 2, 4},
                              Section{"TrianglesP2", 2, 3, &triangle_6},
                              Section{"QuadrilateralsQ2", 2, 4, &quadrilateral_9},
                              Section{"Edges", 1, 2},
                              Section{"EdgesP2", 1, 2, &line_3}};

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
      : path_(path), reader_(path, content), content_(content) {}

  MeshParts parts() {
    if (word("the first word") != medit_title)
      reader_.fail("the first word is not '" + std::string(medit_title) + "'");
    integer("the version");
    for (auto keyword = next_keyword(); !keyword.empty(); keyword = next_keyword())
      if (keyword != "End")
        read_section(keyword);
      else if (!section_follows())
        break;
    parts_.content.format = "medit";
    parts_.content.version = std::to_string(dimension_);
    make_fields();
    add_solution();
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
    } else if (keyword == "Corners") {
      read_marks(keyword, marks_[{corner_field, "Vertices"}]);
    } else if (keyword == "Ridges") {
      read_marks(keyword, marks_[{ridge_field, "Edges"}]);
    } else if (keyword.starts_with("Required") && find_section(keyword.substr(8))) {
      read_marks(keyword, marks_[{required_field, std::string(keyword.substr(8))}]);
    } else if (keyword.ends_with("P2") || keyword.ends_with("Q2") || keyword.ends_with("P3") ||
               keyword.ends_with("Q3") || keyword.ends_with("P4") || keyword.ends_with("Q4")) {
      reader_.fail("the section " + std::string(keyword) +
                   " cannot be read; of elements of second order only EdgesP2, TrianglesP2, "
                   "QuadrilateralsQ2 and TetrahedraP2 are; save the mesh as .msh");
    } else if (keyword.ends_with("Ordering")) {
      reader_.fail("the section " + std::string(keyword) +
                   " gives nodes an order of its own; save the mesh without it");
    } else {
      skipped_.emplace();
      parts_.notes.push_back("the section " + std::string(keyword) + " is left out");
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
      vertex_references_.push_back(reference());
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
    std::array<NodeIndex, 27> nodes{};
    positions_[std::string(section.keyword)] = {n_elements_, n};
    for (std::size_t e = 0; e < n; ++e) {
      for (std::size_t k = 0; k < section.n_nodes(); ++k) {
        nodes[k] = node();
        if (k == 0) elements.lines.push_back(reader_.line());
      }
      const std::span row(nodes.data(), section.n_nodes());
      if (section.order) section.order->from_file(row);
      elements.append_nodes(row, section.n_corners);
      elements.tags.push_back(reference());
      elements.file_positions.push_back(n_elements_++);
    }
  }

  /// Reads the numbers, from 1, of nodes or elements.
  void read_marks(std::string_view keyword, std::vector<std::uint64_t>& marks) {
    for (std::size_t n = count(keyword); n > 0; --n) {
      marks.push_back(integer("the number of an element"));
      if (marks.back() == 0) reader_.fail("the number is 0, but elements are counted from 1");
    }
  }

  /// Makes fields of the vertices' references, and of marks.
  void make_fields() {
    FileContent& content = parts_.content;
    const auto is_set = [](std::int64_t value) { return value != 0; };
    if (std::any_of(vertex_references_.begin(), vertex_references_.end(), is_set))
      content.node_fields.push_back({.name = std::string(medit_reference_field),
                                     .type = NumberType::int32,
                                     .values = vertex_references_});
    for (const auto& [key, numbers] : marks_) {
      const auto& [name, section] = key;
      const bool is_of_nodes = section == "Vertices";
      const auto found = positions_.find(section);
      const Range range = is_of_nodes                 ? Range{0, parts_.coordinates.size()}
                          : found == positions_.end() ? Range{}
                                                      : found->second;
      auto& fields = is_of_nodes ? content.node_fields : content.element_fields;
      auto field =
          std::find_if(fields.begin(), fields.end(),
                       [&, wanted = name](const MeshField& f) { return f.name == wanted; });
      if (field == fields.end()) {
        const std::size_t n = is_of_nodes ? parts_.coordinates.size() : n_elements_;
        fields.push_back(
            {.name = name, .type = NumberType::int32, .values = std::vector<std::int64_t>(n, 0)});
        field = std::prev(fields.end());
      }
      for (const std::uint64_t number : numbers) {
        if (number > range.n)
          reader_.fail("the number " + std::to_string(number) +
                       " of a marked element is not one of " + section + ", of which there are " +
                       std::to_string(range.n));
        std::get<std::vector<std::int64_t>>(field->values)[range.first + number - 1] = 1;
      }
    }
  }

  /// Adds the fields of the file with the solution, if there is one next to the mesh.
  void add_solution() {
    const auto path = medit_solution_path(path_);
    const std::string name = path.filename().string();
    std::error_code error;
    if (std::filesystem::exists(path.string() + "b", error))
      parts_.notes.push_back(name + "b next to the mesh is left out, as it is binary; save it as " +
                             name);
    if (!std::filesystem::is_regular_file(path, error)) return;
    try {
      MeditSolution solution = read_medit_solution(path);
      for (MeditSolutionSection& section : solution.sections) add_section(section);
      parts_.notes.push_back("the solution " + name + " next to the mesh is read with it");
    } catch (const InputError& failure) {
      parts_.notes.push_back("the solution next to the mesh is left out: " +
                             std::string(failure.what()));
    }
  }

  void add_section(MeditSolutionSection& section) {
    const bool is_of_nodes = section.of == "Vertices";
    const auto found = positions_.find(section.of);
    const Range range = is_of_nodes                 ? Range{0, parts_.coordinates.size()}
                        : found == positions_.end() ? Range{}
                                                    : found->second;
    if (section.n_rows != range.n)
      throw InputError("it has " + std::to_string(section.n_rows) + " rows for " +
                       std::to_string(range.n) + " " + section.of);
    auto& fields = is_of_nodes ? parts_.content.node_fields : parts_.content.element_fields;
    for (MeshField& field : section.fields) {
      const std::size_t n = field.n_components,
                        n_rows = is_of_nodes ? range.n : std::size_t{n_elements_};
      auto same = std::find_if(fields.begin(), fields.end(), [&](const MeshField& other) {
        return other.name == field.name && other.n_components == n;
      });
      if (same == fields.end()) {
        fields.push_back({.name = field.name, .n_components = n, .values = {}});
        same = std::prev(fields.end());
        same->values = std::vector<double>(n_rows * n, std::numeric_limits<double>::quiet_NaN());
      }
      std::ranges::copy(std::get<std::vector<double>>(field.values),
                        std::get<std::vector<double>>(same->values).begin() +
                            static_cast<std::ptrdiff_t>(range.first * n));
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

  struct Range {
    std::size_t first = 0, n = 0;
  };

  std::filesystem::path path_;
  LineReader reader_;
  std::string_view content_;
  std::uint64_t dimension_ = 0;
  std::uint32_t n_elements_ = 0;
  std::map<std::string, Range> positions_;  ///< of the elements of each section
  std::vector<std::int64_t> vertex_references_;
  /// Numbers by the name of a field and a section.
  std::map<std::pair<std::string, std::string>, std::vector<std::uint64_t>> marks_;
  std::optional<SkippedSection> skipped_;  ///< the current section
  MeshParts parts_;
};

}  // namespace

bool is_medit_text(std::string_view content) {
  LineReader reader({}, content);
  return reader.next_line() && reader.word() == medit_title;
}

MeshParts read_medit_text(const std::filesystem::path& path, const MeshReadOptions&) {
  const std::string content = read_whole_file(path);
  return MeditReader(path, content).parts();
}

namespace {

/// Returns the facets of the boundary that the file does not have.
CompressedRows<NodeIndex> other_boundary_facets(const MeshView& mesh) {
  const AllElements elements(mesh);
  std::set<std::vector<NodeIndex>> known;
  for (std::size_t e = elements.n_cells(); e < elements.size(); ++e)
    if (elements.dimension(e) == mesh.dimension() - 1)
      known.insert(sorted_nodes(elements.nodes(e)));
  CompressedRows<NodeIndex> facets;
  const auto& boundary = mesh.topology().boundary_facets();
  for (std::size_t f = 0; f < boundary.size(); ++f)
    if (!known.contains(sorted_nodes(boundary[f]))) facets.append(boundary[f]);
  return facets;
}

/// Writes a mesh in Medit's text format.
class MeditWriter {
 public:
  /// more_facets: facets with reference 0 in addition to those of the mesh.
  MeditWriter(const MeshView& mesh, const CompressedRows<NodeIndex>& more_facets)
      : mesh_(mesh), more_facets_(more_facets), elements_(mesh) {
    const FileContent* content = mesh.content();
    is_of_medit_ = content && content->format == "medit";
    dimension_ = !mesh.planar() || (is_of_medit_ && content->version == "3") ? 3 : 2;
    if (content && content->plane) dimension_ = 3;
    for (const std::uint32_t e : elements_.in_file_order(content)) order_.push_back(e);
  }

  std::string text() {
    text_ = std::string(medit_title) + " 2\nDimension " + std::to_string(dimension_) + "\n";
    write_vertices();
    for (const Section& section : sections) write_elements(section);
    write_marks();
    return std::move(text_) + "End\n";
  }

  /// Returns the fields that a solution next to the mesh holds, after text().
  MeditSolution solution() const {
    MeditSolution solution{.dimension = dimension_, .sections = {}};
    if (!mesh_.content()) return solution;
    std::vector<std::uint32_t> all(mesh_.n_nodes());
    std::iota(all.begin(), all.end(), std::uint32_t{0});
    add_section(solution, "Vertices", mesh_.content()->node_fields, all);
    for (const auto& [name, members] : members_)
      add_section(solution, name, mesh_.content()->element_fields, members);
    return solution;
  }

 private:
  void write_vertices() {
    const MeshField* references = field(true, medit_reference_field);
    text_ += "Vertices\n" + std::to_string(mesh_.n_nodes()) + "\n";
    for (NodeIndex i = 0; i < mesh_.n_nodes(); ++i) {
      const Point<3> point = mesh_.point(i);
      for (int d = 0; d < dimension_; ++d) {
        append_number(text_, point[d]);
        text_ += ' ';
      }
      append_number(text_, references ? static_cast<int>(references->number(i)) : 0);
      text_ += '\n';
    }
  }

  void append_row(std::span<const NodeIndex> nodes, int reference) {
    for (const NodeIndex node : nodes) {
      append_number(text_, std::size_t{node} + 1);
      text_ += ' ';
    }
    append_number(text_, reference);
    text_ += '\n';
  }

  void write_elements(const Section& section) {
    std::vector<std::uint32_t> members;
    for (const std::uint32_t e : order_)
      if (elements_.dimension(e) == section.dimension &&
          elements_.nodes(e).size() == section.n_corners &&
          elements_.nodes(e).size() + elements_.midside(e).size() == section.n_nodes())
        members.push_back(e);
    std::size_t n = members.size();
    const bool has_more = section.dimension == mesh_.dimension() - 1;
    for (std::size_t f = 0; has_more && f < more_facets_.size(); ++f)
      n += !section.order && more_facets_[f].size() == section.n_corners;
    if (n == 0) return;
    text_.append(section.keyword).append("\n").append(std::to_string(n)).append("\n");
    for (const std::uint32_t e : members)
      append_row(elements_.row(e, section.order), elements_.tag(e));
    for (std::size_t f = 0; has_more && f < more_facets_.size(); ++f)
      if (!section.order && more_facets_[f].size() == section.n_corners)
        append_row(more_facets_[f], 0);
    members_[std::string(section.keyword)] = std::move(members);
  }

  /// Adds the rows of fields that belong to a section of the mesh, unless none has a value there.
  static void add_section(MeditSolution& solution, const std::string& name,
                          const std::vector<MeshField>& fields,
                          const std::vector<std::uint32_t>& rows) {
    MeditSolutionSection section{.of = name, .n_rows = rows.size(), .fields = {}};
    for (const MeshField& field : fields) {
      if (!is_medit_solution(field)) continue;
      const std::size_t n = field.n_components;
      std::vector<double> values;
      for (const std::uint32_t row : rows)
        for (std::size_t k = 0; k < n; ++k) values.push_back(field.number(row * n + k));
      if (std::none_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); }))
        continue;
      section.fields.push_back({.name = field.name, .n_components = n, .values = {}});
      section.fields.back().values = std::move(values);
    }
    if (!section.fields.empty()) solution.sections.push_back(std::move(section));
  }

  /// Returns null if the mesh has no such field.
  const MeshField* field(bool is_of_nodes, std::string_view name) const {
    if (!mesh_.content()) return nullptr;
    const auto& fields =
        is_of_nodes ? mesh_.content()->node_fields : mesh_.content()->element_fields;
    const auto found = std::find_if(fields.begin(), fields.end(), [&](const MeshField& f) {
      return f.name == name && f.n_components == 1;
    });
    return found == fields.end() ? nullptr : &*found;
  }

  void write_numbers(const std::string& keyword, const std::vector<std::size_t>& numbers) {
    text_ += keyword + "\n" + std::to_string(numbers.size());
    for (const std::size_t number : numbers) text_ += "\n" + std::to_string(number);
    text_ += "\n";
  }

  /// A file of Medit gets the required vertices that it had, any other file all fixed nodes.
  void write_marks() {
    const Topology& topology = mesh_.topology();
    std::vector<std::size_t> required, corners;
    const MeshField* is_corner = field(true, corner_field);
    const MeshField* is_marked = field(true, required_field);
    for (NodeIndex i = 0; i < mesh_.n_nodes(); ++i) {
      const FixedReasons reasons = topology.reasons_to_stay(i);
      const bool is_required = is_marked && is_marked->number(i) != 0.0;
      if (is_required || (is_of_medit_ ? has(reasons, FixedReason::marked) : reasons != 0))
        required.push_back(std::size_t{i} + 1);
      if (is_corner && is_corner->number(i) != 0.0) corners.push_back(std::size_t{i} + 1);
    }
    if (!corners.empty()) write_numbers("Corners", corners);
    if (!required.empty() || !is_of_medit_) write_numbers("RequiredVertices", required);
    if (const MeshField* ridges = field(false, ridge_field))
      write_marked("Ridges", "Edges", *ridges);
    if (const MeshField* marks = field(false, required_field))
      for (const Section& section : sections)
        write_marked("Required" + std::string(section.keyword), std::string(section.keyword),
                     *marks);
  }

  void write_marked(const std::string& keyword, const std::string& section,
                    const MeshField& marks) {
    const auto& members = members_[section];
    std::vector<std::size_t> numbers;
    for (std::size_t k = 0; k < members.size(); ++k)
      if (marks.number(members[k]) != 0.0) numbers.push_back(k + 1);
    if (!numbers.empty()) write_numbers(keyword, numbers);
  }

  const MeshView& mesh_;
  const CompressedRows<NodeIndex>& more_facets_;
  AllElements elements_;
  bool is_of_medit_ = false;
  int dimension_ = 3;
  std::vector<std::uint32_t> order_;
  std::map<std::string, std::vector<std::uint32_t>> members_;  ///< elements of each section
  std::string text_;
};

bool has_section(int dimension, std::size_t n_corners, std::size_t n_midside) {
  return std::any_of(sections.begin(), sections.end(), [&](const Section& section) {
    return section.dimension == dimension && section.n_corners == n_corners &&
           section.n_nodes() == n_corners + n_midside;
  });
}

}  // namespace

void write_medit_text(const std::filesystem::path& path, const MeshView& mesh, const MeshFields&,
                      const MeshWriteOptions&) {
  require_no_polygons(path, mesh);
  require_held(path, mesh, "Medit", ".msh or .vtu", has_section);
  const CompressedRows<NodeIndex> no_facets;
  MeditWriter writer(mesh, no_facets);
  write_atomically(path, writer.text());
  if (const MeditSolution solution = writer.solution(); !solution.sections.empty())
    write_medit_solution(medit_solution_path(path), solution);
}

void write_medit_with_boundary(const std::filesystem::path& path, const MeshView& mesh) {
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    if (mesh.topology().cell_type(c) == ElementType::polygon)
      throw InputError(
          "cannot write " + path.string() + ": cell " + std::to_string(c) + " has " +
          std::to_string(mesh.topology().cell_nodes(c).size()) +
          " nodes, but Medit's cells of planar meshes have three or four; use the format "
          "vtk or mesh");
  write_atomically(path, MeditWriter(mesh, other_boundary_facets(mesh)).text());
}

namespace {

bool holds_field(const MeshField& field, bool is_of_file) {
  const auto& name = field.name;
  return !is_of_file && (name == medit_reference_field || name == corner_field ||
                         name == required_field || name == ridge_field || is_medit_solution(field));
}

const RegisteredFormat medit(
    {.name = "medit",
     .extension = ".mesh",
     .description = "Medit, text; written for planar meshes that have labels",
     .holds_planar_meshes = true,
     .holds_volume_meshes = true,
     .holds_second_order = true,
     .adds_fixed_nodes = true,
     .holds_facets = true,
     .min_element_dimension = 1,
     .holds_field = holds_field,
     .recognizes = is_medit_text,
     .read = read_medit_text,
     .write = write_medit_text});

}  // namespace

}  // namespace smoothfem
