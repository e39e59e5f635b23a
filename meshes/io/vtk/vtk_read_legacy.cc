// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/io/vtk/vtk_files.h"
#include "meshes/io/vtk/vtk_grid.h"
#include "meshes/io/vtk/vtk_legacy_input.h"

namespace smoothfem {

namespace {

/// The cell sections of polygonal data in the order in which cell arrays count them. Each has VTK's
/// types of cells with few nodes and of all other cells. An unstructured grid has the first section
/// only.
struct PolygonalSection {
  std::string_view keyword;
  std::size_t n_nodes;
  std::uint8_t type_of_few, next_type, type_of_many;
};
constexpr std::array polygonal_sections{
    PolygonalSection{"vertices", 1, 1, 2, 2}, PolygonalSection{"lines", 2, 3, 4, 4},
    PolygonalSection{"polygons", 3, 5, 9, 7}, PolygonalSection{"triangle_strips", 0, 6, 6, 6}};

std::uint8_t type_of(const PolygonalSection& section, std::size_t n_nodes) {
  return n_nodes == section.n_nodes       ? section.type_of_few
         : n_nodes == section.n_nodes + 1 ? section.next_type
                                          : section.type_of_many;
}

/// Reads the sections of a file. No count is trusted: memory is allocated only for content that the
/// file can hold.
class LegacyVtkReader {
 public:
  LegacyVtkReader(const std::filesystem::path& path, std::string_view content)
      : in_(path, content) {}

  VtkGrid grid() {
    read_data_set();
    while (in_.next_keyword()) read_section(in_.keyword());
    for (VtkCells& cells : cells_) grid_.cells.append(std::move(cells));
    grid_.is_binary = in_.is_binary();
    grid_.is_polygonal = is_polygonal_;
    return std::move(grid_);
  }

 private:
  /// Owner of arrays.
  enum class Attributes { field, cells, points };

  void read_data_set() {
    if (!in_.next_keyword() || in_.keyword() != "dataset")
      in_.fail("expected 'DATASET' after the file type");
    const std::string kind = lower_case(in_.word("the kind of the data set"));
    is_polygonal_ = kind == "polydata";
    if (!is_polygonal_ && kind != "unstructured_grid")
      in_.fail("the file holds no unstructured grid and no polygonal data, but " + in_quotes(kind));
  }

  void read_section(const std::string& keyword) {
    if (keyword == "points") return read_points();
    if (keyword == "metadata") return in_.skip_metadata();
    if (keyword == "cell_data" || keyword == "point_data") return begin_attributes(keyword);
    if (!is_polygonal_ && keyword == "cells") return read_cells(cells_[0]);
    if (!is_polygonal_ && keyword == "cell_types") return read_types();
    for (std::size_t s = 0; is_polygonal_ && s < polygonal_sections.size(); ++s)
      if (keyword == polygonal_sections[s].keyword) return read_polygonal(s);
    if (keyword == "field") return read_field();
    if (attributes_ == Attributes::field || !read_attribute(keyword))
      in_.fail("expected the name of a section, but found " + in_quotes(keyword) +
               "; the previous section has more numbers than announced, or the file is damaged");
  }

  void read_points() {
    if (!grid_.points.empty()) in_.fail("there is a second section POINTS");
    const std::uint64_t n = in_.count("the number of points");
    const VtkNumber type = in_.number_type();
    in_.require_numbers(n, 3, type, "points");
    grid_.points.resize(n);
    double* coordinate = n > 0 ? grid_.points[0].data() : nullptr;
    in_.read_numbers<double>(type, 3 * n, "a coordinate",
                             [&](double value) { *coordinate++ = value; });
  }

  void read_cells(VtkCells& cells) {
    if (cells.size() > 0) in_.fail("there is a second section of the same cells");
    const std::uint64_t n = in_.count("the number of cells");
    const std::uint64_t size = in_.count("the size of the cells");
    if (in_.version() < 5)
      read_rows(cells, n, size);
    else if (n > 0)  // the number of offsets
      read_offsets_and_nodes(cells, n, size);
  }

  [[noreturn]] void refuse_rows() const {
    in_.fail("the section does not have the rows it announces; the file is truncated or damaged");
  }

  void add_node(VtkCells& cells, std::int64_t point) {
    if (!cells.add_node(point, grid_.points.size()))
      in_.fail(cells.missing_point(point, grid_.points.size()));
  }

  /// Reads n rows "k i1 .. ik" with `size` integers altogether.
  void read_rows(VtkCells& cells, std::uint64_t n, std::uint64_t size) {
    in_.require_numbers(size, 1, VtkNumber::int32, "integers");
    if (n > size) refuse_rows();
    cells.offsets.reserve(n + 1);
    cells.nodes.reserve(size - n);
    std::uint64_t n_left = size, row_left = 0;
    bool in_row = false;
    in_.read_numbers<std::int64_t>(VtkNumber::int32, size, "a cell", [&](std::int64_t value) {
      --n_left;
      if (in_row) {
        add_node(cells, value);
        --row_left;
      } else {
        if (value < 0 || static_cast<std::uint64_t>(value) > n_left || cells.size() == n)
          refuse_rows();
        row_left = static_cast<std::uint64_t>(value);
      }
      in_row = row_left > 0;
      if (!in_row) cells.end_cell();
    });
    if (in_row || cells.size() != n) refuse_rows();
  }

  /// Reads cells in the form of version 5 and later.
  void read_offsets_and_nodes(VtkCells& cells, std::uint64_t n_offsets, std::uint64_t n_nodes) {
    in_.require_keyword("offsets");
    VtkNumber type = in_.integer_type();
    in_.require_numbers(n_offsets, 1, type, "offsets");
    cells.offsets.clear();
    cells.offsets.reserve(n_offsets);
    in_.read_numbers<std::int64_t>(type, n_offsets, "an offset", [&](std::int64_t offset) {
      const bool is_first = cells.offsets.empty();
      const std::int64_t least = is_first ? 0 : cells.offsets.back();
      const std::uint64_t most = is_first ? 0 : std::min<std::uint64_t>(n_nodes, UINT32_MAX);
      if (offset < least || static_cast<std::uint64_t>(offset) > most) refuse_rows();
      cells.offsets.push_back(static_cast<RowOffset>(offset));
    });
    if (cells.offsets.back() != n_nodes) refuse_rows();
    in_.require_keyword("connectivity");
    type = in_.integer_type();
    in_.require_numbers(n_nodes, 1, type, "nodes");
    cells.nodes.reserve(n_nodes);
    in_.read_numbers<std::int64_t>(type, n_nodes, "a cell",
                                   [&](std::int64_t point) { add_node(cells, point); });
  }

  void read_types() {
    const std::uint64_t n = in_.count("the number of cell types");
    in_.require_numbers(n, 1, VtkNumber::int32, "cell types");
    std::vector<std::uint8_t>& types = cells_[0].types;
    if (!types.empty()) in_.fail("there is a second section CELL_TYPES");
    types.reserve(n);
    in_.read_numbers<std::int64_t>(VtkNumber::int32, n, "a cell type", [&](std::int64_t type) {
      types.push_back(in_.cell_type(types.size(), type));
    });
  }

  void read_polygonal(std::size_t s) {
    VtkCells& cells = cells_[s];
    read_cells(cells);
    for (std::size_t c = 0; c < cells.size(); ++c)
      cells.types.push_back(
          type_of(polygonal_sections[s], cells.offsets[c + 1] - cells.offsets[c]));
  }

  void begin_attributes(const std::string& keyword) {
    const bool of_cells = keyword == "cell_data";
    attributes_ = of_cells ? Attributes::cells : Attributes::points;
    n_tuples_ = in_.count("the number of values");
    std::size_t n = of_cells ? 0 : grid_.points.size();
    for (std::size_t s = 0; of_cells && s < cells_.size(); ++s) n += cells_[s].size();
    if (n_tuples_ != n)
      in_.fail("there are " + std::to_string(n_tuples_) + " values announced for " +
               std::to_string(n) + (of_cells ? " cells" : " points"));
  }

  /// Returns false if the keyword begins no attribute.
  bool read_attribute(const std::string& keyword) {
    const auto* role = std::find_if(vtk_roles.begin(), vtk_roles.end(),
                                    [&](const VtkRole& entry) { return entry.keyword == keyword; });
    if (role == vtk_roles.end() && keyword != "lookup_table" && keyword != "color_scalars")
      return false;
    const std::string name(in_.word("the array's name"));
    if (keyword == "lookup_table") {
      in_.skip_colours(in_.count("the size of the lookup table"), 4);
      grid_.notes.push_back("the lookup table '" + name + "' is left out");
    } else if (keyword == "color_scalars") {
      const std::uint64_t n_components = in_.count("the number of components");
      in_.skip_colours(n_tuples_, n_components);
      grid_.notes.push_back("the colours '" + name + "' are left out");
    } else if (keyword == "scalars") {
      const std::string type(in_.word("the array's type"));
      const std::uint64_t n_components = in_.has_word() ? in_.count("the number of components") : 1;
      in_.require_keyword("lookup_table");
      in_.word("the name of the lookup table");
      read_array(name, type, n_components, n_tuples_);
    } else {
      const std::uint64_t n_components =
          role->n_components > 0 ? role->n_components : in_.count("the number of components");
      read_array(name, std::string(in_.word("the array's type")), n_components, n_tuples_);
    }
    if (role != vtk_roles.end())  // VTK, too, uses the first array of a role
      (attributes_ == Attributes::cells ? grid_.cell_roles : grid_.point_roles)
          .emplace(role->name, decoded_vtk_name(name));
    return true;
  }

  void read_field() {
    in_.word("the field's name");
    for (std::uint64_t n = in_.count("the number of the field's arrays"); n > 0; --n) {
      std::string name(in_.word("an array of the field"));
      while (name == "METADATA") {
        in_.skip_metadata();
        name = in_.word("an array of the field");
      }
      if (name == "NULL_ARRAY") continue;
      const std::uint64_t n_components = in_.count("the number of components");
      const std::uint64_t n_tuples = in_.count("the number of values");
      read_array(name, std::string(in_.word("the array's type")), n_components, n_tuples);
    }
  }

  /// Keeps arrays of numbers; skips all others, with a note.
  void read_array(const std::string& encoded_name, const std::string& type_name,
                  std::uint64_t n_components, std::uint64_t n_tuples) {
    const std::string name = decoded_vtk_name(encoded_name);
    const auto type = in_.number_type(type_name);
    if (!type || n_components == 0) {
      grid_.notes.push_back("the array '" + name + "' is left out: it has no numbers");
      return in_.skip_array(type_name, n_components, n_tuples);
    }
    in_.require_numbers(n_tuples, n_components, *type, "values");
    if (attributes_ == Attributes::field && name == vtk_names_array) {
      std::uint64_t component = 0;
      in_.read_numbers<AnyNumber>(*type, n_components * n_tuples, "a value", [&](AnyNumber number) {
        if (component == 0) grid_.physical_names += vtk_character(number.value);
        if (++component == n_components) component = 0;
      });
      return;
    }
    MeshField field{.name = name, .n_components = n_components, .type = *type};
    const std::uint64_t n = n_components * n_tuples;
    if (is_integer(*type)) {
      auto& values = field.values.emplace<std::vector<std::int64_t>>();
      values.reserve(n);
      in_.read_numbers<AnyInteger>(*type, n, "a value",
                                   [&](AnyInteger number) { values.push_back(number.value); });
    } else {
      auto& values = field.values.emplace<std::vector<double>>();
      values.reserve(n);
      in_.read_numbers<AnyNumber>(*type, n, "a value",
                                  [&](AnyNumber number) { values.push_back(number.value); });
    }
    auto& fields = attributes_ == Attributes::field   ? grid_.file_fields
                   : attributes_ == Attributes::cells ? grid_.cell_fields
                                                      : grid_.point_fields;
    std::erase_if(fields, [&](const MeshField& other) { return other.name == name; });
    fields.push_back(std::move(field));
  }

  LegacyVtkInput in_;
  bool is_polygonal_ = false;
  Attributes attributes_ = Attributes::field;
  std::uint64_t n_tuples_ = 0;
  std::array<VtkCells, polygonal_sections.size()> cells_;  ///< by section of polygonal data
  VtkGrid grid_;
};

MeshParts legacy_vtk_parts(const std::filesystem::path& path, const MeshReadOptions& options) {
  const std::string content = read_whole_file(path);
  auto parts =
      parts_of_grid(path.string(), LegacyVtkReader(path, content).grid(), options.tag_field);
  parts.content.format = "vtk";
  return parts;
}

}  // namespace

MeshParts read_legacy_vtk(const std::filesystem::path& path, const MeshReadOptions& options) {
  return legacy_vtk_parts(path, options);
}

}  // namespace smoothfem
