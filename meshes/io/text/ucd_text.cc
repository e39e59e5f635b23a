// SPDX-License-Identifier: GPL-3.0-or-later
/// The format UCD of AVS, text, which shares the extension .inp with Abaqus. Only read.
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>

#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_assembly.h"

namespace smoothfem {

namespace {

/// An element type; order[k] is the position in the file of node k of volume_elements.h. The first
/// nodes of volume elements are those of the top (AVS Developer's Guide, "UCD file format").
struct UcdElement {
  std::string_view name;
  int dimension;
  std::size_t n_nodes;
  std::array<std::size_t, 8> order;
};
constexpr std::array ucd_elements{UcdElement{"pt", 0, 1, {0}},
                                  UcdElement{"line", 1, 2, {0, 1}},
                                  UcdElement{"tri", 2, 3, {0, 1, 2}},
                                  UcdElement{"quad", 2, 4, {0, 1, 2, 3}},
                                  UcdElement{"tet", 3, 4, {0, 1, 3, 2}},
                                  UcdElement{"pyr", 3, 5, {1, 2, 3, 4, 0}},
                                  UcdElement{"prism", 3, 6, {3, 4, 5, 0, 1, 2}},
                                  UcdElement{"hex", 3, 8, {4, 5, 6, 7, 0, 1, 2, 3}}};

class UcdReader {
 public:
  UcdReader(const std::filesystem::path& path, std::string_view content)
      : reader_(path, content, ", \t\r\v\f") {}

  MeshParts parts() {
    next_line("the numbers of nodes and cells");
    const std::size_t n_nodes = count("the number of nodes"),
                      n_cells = count("the number of cells");
    const std::size_t n_of_nodes = count("the number of data of a node"),
                      n_of_cells = count("the number of data of a cell"),
                      n_of_file = count("the number of data of the model");
    read_nodes(n_nodes);
    read_cells(n_cells);
    if (n_of_nodes > 0) read_data(n_of_nodes, parts_.node_ids, parts_.content.node_fields);
    if (n_of_cells > 0) read_data(n_of_cells, cell_ids_, parts_.content.element_fields);
    if (n_of_file > 0) parts_.notes.emplace_back("the data of the whole model are left out");
    parts_.content.format = "ucd";
    parts_.notes.emplace_back(
        "the file has the format UCD of AVS, which is only read; .inp files are written for "
        "Abaqus");
    return std::move(parts_);
  }

 private:
  void next_line(std::string_view what) {
    do reader_.require_line(what);
    while (reader_.text().starts_with('#'));
  }

  /// Reads a count. It cannot exceed the bytes of the file.
  std::size_t count(std::string_view what) {
    const std::uint64_t n = reader_.integer(what);
    if (n > reader_.rest().size())
      reader_.fail(std::string(what) + " is " + std::to_string(n) +
                   ", more than the file can have; it is truncated or the number is wrong");
    return n;
  }

  void read_nodes(std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      next_line("a node");
      parts_.node_ids.push_back(reader_.integer("the node's number"));
      if (!index_of_.emplace(parts_.node_ids.back(), static_cast<NodeIndex>(i)).second)
        reader_.fail("the node " + std::to_string(parts_.node_ids.back()) + " appears twice");
      Point<3>& point = parts_.coordinates.emplace_back();
      for (double& x : point) x = reader_.number("a coordinate");
    }
  }

  void read_cells(std::size_t n) {
    for (std::size_t c = 0; c < n; ++c) {
      next_line("a cell");
      cell_ids_.push_back(reader_.integer("the cell's number"));
      const double tag = reader_.number("the cell's material");
      const std::string name = lower_case(reader_.word());
      const auto* type =
          std::find_if(ucd_elements.begin(), ucd_elements.end(),
                       [&](const UcdElement& element) { return element.name == name; });
      if (type == ucd_elements.end())
        reader_.fail("the cell type " + in_quotes(name) +
                     " is not one of pt, line, tri, quad, tet, pyr, prism and hex");
      std::array<NodeIndex, 8> listed{}, nodes{};
      for (std::size_t k = 0; k < type->n_nodes; ++k) listed[k] = node();
      reader_.require_end_of_line();
      for (std::size_t k = 0; k < type->n_nodes; ++k) nodes[k] = listed[type->order[k]];
      ElementList& elements = parts_.elements[static_cast<std::size_t>(type->dimension)];
      elements.nodes.append(std::span(nodes).first(type->n_nodes));
      elements.tags.push_back(
          std::abs(tag) <= std::numeric_limits<int>::max() ? static_cast<int>(tag) : 0);
      elements.ids.push_back(cell_ids_.back());
      elements.lines.push_back(reader_.line());
      elements.file_positions.push_back(static_cast<std::uint32_t>(c));
    }
  }

  NodeIndex node() {
    const std::uint64_t number = reader_.integer("the node");
    const auto found = index_of_.find(number);
    if (found == index_of_.end())
      reader_.fail("the cell names node " + std::to_string(number) +
                   ", which the file does not have");
    return found->second;
  }

  /// Reads the data of all nodes or cells, whose rows begin with their number: first the number of
  /// fields and their components, then a line "name, unit" for each.
  void read_data(std::size_t n_numbers, const std::vector<std::size_t>& ids,
                 std::vector<MeshField>& fields) {
    next_line("the number of fields");
    const std::size_t n_fields = count("the number of fields"), first = fields.size();
    std::size_t n_found = 0;
    for (std::size_t f = 0; f < n_fields; ++f) {
      MeshField& field = fields.emplace_back();
      field.n_components = count("the number of components");
      n_found += field.n_components;
      if (field.n_components == 0 || n_found > n_numbers)
        reader_.fail("the fields have not " + std::to_string(n_numbers) +
                     " components, as the first line says");
    }
    for (std::size_t f = first; f < fields.size(); ++f) {
      next_line("the name of a field");
      const std::string_view name = reader_.text().substr(0, reader_.text().find(','));
      const std::size_t begin = std::min(name.find_first_not_of(" \t"), name.size());
      fields[f].name = name.substr(begin, name.find_last_not_of(" \t\r") + 1 - begin);
    }
    std::unordered_map<std::size_t, std::size_t> rows;
    for (std::size_t i = 0; i < ids.size(); ++i) rows.emplace(ids[i], i);
    std::vector<std::vector<double>> values;
    for (std::size_t f = first; f < fields.size(); ++f)
      values.emplace_back(ids.size() * fields[f].n_components,
                          std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      next_line("a row of data");
      const auto row = rows.find(reader_.integer("the number of a node or cell"));
      if (row == rows.end()) reader_.fail("the row of data is of no node or cell of the file");
      for (std::size_t f = first; f < fields.size(); ++f)
        for (std::size_t k = 0; k < fields[f].n_components; ++k)
          values[f - first][row->second * fields[f].n_components + k] = reader_.number("a value");
    }
    for (std::size_t f = first; f < fields.size(); ++f)
      fields[f].values = std::move(values[f - first]);
  }

  LineReader reader_;
  std::unordered_map<std::size_t, NodeIndex> index_of_;
  std::vector<std::size_t> cell_ids_;
  MeshParts parts_;
};

/// Binary files begin with this byte.
bool is_binary(std::string_view content) {
  return content.starts_with('\x07');
}

MeshParts read_ucd(const std::filesystem::path& path, const MeshReadOptions&) {
  const std::string content = read_whole_file(path);
  if (is_binary(content))
    throw InputError(path.string() +
                     ": the file is binary UCD of AVS, which is not read; save it as text");
  return UcdReader(path, content).parts();
}

std::size_t n_integers(LineReader& reader) {
  std::size_t n = 0;
  for (auto word = reader.word(); !word.empty(); word = reader.word(), ++n)
    if (!std::all_of(word.begin(), word.end(),
                     [](char c) { return std::isdigit(static_cast<unsigned char>(c)); }))
      return 0;
  return n;
}

/// True if the file is binary or the first line that is no comment has the five counts.
bool is_ucd(std::string_view beginning) {
  if (is_binary(beginning)) return true;
  LineReader reader({}, beginning);
  while (reader.next_line())
    if (!reader.text().starts_with('#')) return n_integers(reader) == 5;
  return false;
}

const RegisteredFormat ucd({.name = "ucd",
                            .extension = ".inp",
                            .description = "UCD of AVS, text; only read",
                            .recognizes = is_ucd,
                            .read = read_ucd});

}  // namespace

}  // namespace smoothfem
