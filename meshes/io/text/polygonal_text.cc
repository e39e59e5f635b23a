// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/text/polygonal_text.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>

#include "meshes/io/atomic_file.h"
#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_assembly.h"
#include "smoothing/quality/mean_ratio.h"

namespace smoothfem {

namespace {

constexpr std::string_view first_line = "planar_polygonal_mesh";

/// Returns "node 5 of 11", counted from 1.
std::string nth(const std::string& what, std::size_t i, std::size_t n) {
  return what + " " + std::to_string(i + 1) + " of " + std::to_string(n);
}

/// Returns the count of the present section line `keyword count`. A count cannot exceed the
/// remaining bytes, so that a wrong one is found before memory is allocated.
std::size_t section_count(LineReader& reader, const std::string& keyword) {
  const std::string_view found = reader.word();
  if (found != keyword)
    reader.fail("expected '" + keyword +
                "' and a count; the previous section has more lines than " +
                "announced, or the file is not a polygonal mesh");
  const std::size_t count = reader.integer("the count of " + keyword);
  reader.require_end_of_line();
  if (count > reader.rest().size())
    reader.fail("'" + keyword + "' announces " + std::to_string(count) +
                " lines, more than the file has; it is truncated or the count is wrong");
  return count;
}

std::vector<Point<3>> read_nodes(LineReader& reader) {
  reader.require_line("the section 'nodes'");
  std::vector<Point<3>> coordinates(section_count(reader, "nodes"), Point<3>::Zero());
  if (coordinates.size() > std::numeric_limits<NodeIndex>::max())
    reader.fail("the mesh has more nodes than 32 bits can count");
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    reader.require_line(nth("node", i, coordinates.size()));
    coordinates[i].x() = reader.number("the x coordinate");
    coordinates[i].y() = reader.number("the y coordinate");
    reader.require_end_of_line();
  }
  return coordinates;
}

void read_polygons(LineReader& reader, MeshParts& parts) {
  reader.require_line("the section 'polygons'");
  const std::size_t n_cells = section_count(reader, "polygons");
  ElementList& polygons = parts.elements[2];
  std::vector<NodeIndex> nodes;
  for (std::size_t c = 0; c < n_cells; ++c) {
    reader.require_line(nth("polygon", c, n_cells));
    const std::size_t n = reader.integer("the number of the polygon's nodes");
    if (n < 3) reader.fail("the polygon has " + std::to_string(n) + " nodes; it needs at least 3");
    nodes.clear();
    for (std::size_t k = 0; k < n; ++k)  // stops at the end of the line, however large n is
      nodes.push_back(static_cast<NodeIndex>(
          reader.integer(nth("node index", k, n), parts.coordinates.size())));
    reader.require_end_of_line();
    polygons.nodes.append(nodes);
    polygons.lines.push_back(reader.line());
  }
}

std::vector<bool> read_fixed(LineReader& reader, std::size_t n_nodes) {
  reader.require_line("the section 'fixed_node_indices'");
  const std::size_t n_fixed = section_count(reader, "fixed_node_indices");
  std::vector<bool> fixed(n_nodes, false);
  for (std::size_t i = 0; i < n_fixed; ++i) {
    reader.require_line(nth("fixed node", i, n_fixed));
    fixed[reader.integer("the fixed node index", n_nodes)] = true;
    reader.require_end_of_line();
  }
  return fixed;
}

void skip_quality_numbers(LineReader& reader, std::size_t n_cells) {
  const std::size_t n = section_count(reader, "polygon_mean_ratio_quality_numbers");
  if (n != n_cells)
    reader.fail("there are " + std::to_string(n) + " quality numbers for " +
                std::to_string(n_cells) + " polygons");
  for (std::size_t c = 0; c < n; ++c) {
    reader.require_line(nth("quality number", c, n));
    reader.number("the quality number");
    reader.require_end_of_line();
  }
  if (reader.next_line()) reader.fail("unexpected text after the last quality number; remove it");
}

}  // namespace

MeshParts read_polygonal_text(const std::filesystem::path& path, const MeshReadOptions&) {
  const std::string content = read_whole_file(path);
  LineReader reader(path, content);
  reader.require_line("the first line");
  if (reader.word() != first_line)
    reader.fail("the first line is not '" + std::string(first_line) +
                "' (planar polygonal mesh) and not 'MeshVersionFormatted' (Medit); the format of "
                "this file is unknown");
  reader.require_end_of_line();
  MeshParts parts;
  parts.coordinates = read_nodes(reader);
  read_polygons(reader, parts);
  parts.fixed = read_fixed(reader, parts.coordinates.size());
  if (reader.next_line()) skip_quality_numbers(reader, parts.elements[2].nodes.size());
  return parts;
}

namespace {

void append_padded(std::string& text, double value, char end) {
  char digits[32];
  const int n = std::snprintf(digits, sizeof digits, "%+.17e%c", value, end);
  text.append(digits, static_cast<std::size_t>(n));
}

}  // namespace

void write_polygonal_text(const std::filesystem::path& path, const MeshView& view,
                          const MeshFields&, const MeshWriteOptions&) {
  const PlanarMesh& mesh = *view.planar();
  const Topology& topology = mesh.topology();
  std::string text(first_line);
  text += "\nnodes " + std::to_string(mesh.n_nodes()) + "\n";
  for (const auto& point : mesh.coordinates()) {
    append_padded(text, point.x(), ' ');
    append_padded(text, point.y(), '\n');
  }
  text += "polygons " + std::to_string(mesh.n_cells()) + "\n";
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    text += std::to_string(topology.cell_nodes(c).size());
    for (const NodeIndex node : topology.cell_nodes(c))
      text.append(1, ' ').append(std::to_string(node));
    text += "\n";
  }
  text +=
      "fixed_node_indices " + std::to_string(mesh.n_nodes() - topology.free_nodes().size()) + "\n";
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    if (topology.is_fixed(i)) text += std::to_string(i) + "\n";
  text += "polygon_mean_ratio_quality_numbers " + std::to_string(mesh.n_cells()) + "\n";
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    append_padded(text, cell_mean_ratio(mesh, c), '\n');
  write_atomically(path, text);
}

namespace {

const RegisteredFormat polygonal({.name = "polygonal",
                                  .extension = ".mesh",
                                  .description = "planar polygonal mesh, text",
                                  .holds_planar_meshes = true,
                                  .holds_polygons = true,
                                  .holds_tags = false,
                                  .holds_fixed_nodes = true,
                                  .holds_points_in_space = false,
                                  .read = read_polygonal_text,
                                  .write = write_polygonal_text});

}  // namespace

}  // namespace smoothfem
