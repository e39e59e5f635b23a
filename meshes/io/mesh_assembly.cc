// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/mesh_assembly.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>
#include <string>

#include "meshes/doctor/repair.h"
#include "smoothing/base/input_error.h"
#include "smoothing/base/text.h"
#include "smoothing/surface/surface_constraints.h"

namespace smoothfem {

namespace {

/// Returns the file's numbers if they differ from the order; otherwise nothing.
std::vector<std::size_t> worth_keeping(std::vector<std::size_t> ids) {
  bool plain = true, ascending = true;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] == 0) return {};
    plain = plain && ids[i] == i + 1;
    ascending = ascending && (i == 0 || ids[i] > ids[i - 1]);
  }
  if (plain) return {};
  if (ascending) return ids;
  auto sorted = ids;
  std::sort(sorted.begin(), sorted.end());
  const bool unique = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
  return unique ? ids : std::vector<std::size_t>();
}

MeshLabels labels_of(MeshParts& parts, int dim) {
  MeshLabels labels;
  auto& cells = parts.elements[dim];
  const auto is_set = [](int tag) { return tag != 0; };
  if (std::any_of(cells.tags.begin(), cells.tags.end(), is_set))
    labels.cell_tags = std::move(cells.tags);
  labels.cell_ids = worth_keeping(std::move(cells.ids));
  labels.node_ids = worth_keeping(std::move(parts.node_ids));
  const auto& facets = parts.elements[dim - 1];
  for (std::size_t f = 0; f < facets.tags.size(); ++f) {
    const bool fits = dim == 2 || facets.nodes[f].size() <= 4;  // no cell has such a face
    if (facets.tags[f] == 0 || !fits) continue;
    labels.facets.append(facets.nodes[f]);
    labels.facet_tags.push_back(facets.tags[f]);
  }
  for (const auto& [key, name] : parts.names)
    if (key.first == dim || key.first == dim - 1) labels.names[key] = name;
  return labels;
}

std::vector<Point<2>> without_z(const std::vector<Point<3>>& points) {
  std::vector<Point<2>> result;
  result.reserve(points.size());
  for (const auto& point : points) result.emplace_back(point.x(), point.y());
  return result;
}

std::shared_ptr<const Topology> make_topology(MeshParts& parts, int dim) {
  const std::size_t n_nodes = parts.coordinates.size();
  MeshLabels labels = labels_of(parts, dim);
  auto& cells = parts.elements[dim].nodes;
  if (parts.fixed && parts.fixes_boundary_as_well) {
    const Topology alone(dim, n_nodes, cells);
    for (std::size_t i = 0; i < n_nodes; ++i)
      if (alone.on_boundary()[i]) (*parts.fixed)[i] = true;
  }
  return std::make_shared<const Topology>(dim, n_nodes, std::move(cells), std::move(parts.fixed),
                                          std::move(labels));
}

AnyMesh make_mesh(MeshParts& parts, int dim) {
  if (parts.coordinates.size() >= std::numeric_limits<NodeIndex>::max())
    throw InputError("the mesh has more nodes than 32 bits can count");
  if (dim == 2 && !is_planar(parts)) {
    MeshLabels labels = labels_of(parts, dim);
    return make_surface_mesh(std::move(parts.elements[dim].nodes), std::move(parts.coordinates),
                             std::move(labels), std::move(parts.fixed));
  }
  auto topology = make_topology(parts, dim);
  if (dim == 3) return VolumeMesh(std::move(topology), std::move(parts.coordinates));
  return PlanarMesh(std::move(topology), without_z(parts.coordinates));
}

/// Largest coordinate: its sixth powers (squares of volumes) do not overflow.
constexpr double largest_coordinate = 1e50;

}  // namespace

void require_usable_coordinates(const MeshParts& parts) {
  for (std::size_t i = 0; i < parts.coordinates.size(); ++i) {
    for (const double x : parts.coordinates[i]) {
      if (std::abs(x) <= largest_coordinate) continue;
      const bool has_id = !parts.node_ids.empty() && parts.node_ids[i] != 0;
      std::string text =
          "node " + std::to_string(has_id ? parts.node_ids[i] : i) + " has the coordinate ";
      append_number(text, x);
      throw InputError(text + (std::isfinite(x) ? ", so large that sizes of cells overflow; "
                                                  "choose a larger unit of length"
                                                : ", which is not a finite number"));
    }
  }
}

int dimension_of(const MeshParts& parts) {
  return parts.elements[3].nodes.empty() ? 2 : 3;
}

bool is_planar(const MeshParts& parts) {
  const auto& points = parts.coordinates;
  return std::all_of(points.begin(), points.end(),
                     [&](const auto& point) { return point.z() == points.front().z(); });
}

MeshFile assemble_mesh(const std::filesystem::path& path, MeshParts parts,
                       const MeshReadOptions& options) {
  const int dim = dimension_of(parts);
  std::vector<std::size_t> lines;
  try {
    if (parts.leaves_out_unused_nodes) drop_unused_nodes(parts);
    require_usable_coordinates(parts);
    auto notes = repair_while_reading(parts, options);
    lines = std::move(parts.elements[dim].lines);
    return {make_mesh(parts, dim), lines, std::move(notes)};
  } catch (const CellError& error) {
    std::string position = path.string() + ":";
    if (!lines.empty()) position += std::to_string(lines[error.cell()]) + ":";
    throw InputError(position + " " + error.what());
  } catch (const InputError& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

std::string physical_name_line(const std::pair<int, int>& dimension_and_tag,
                               const std::string& name) {
  return std::to_string(dimension_and_tag.first) + " " + std::to_string(dimension_and_tag.second) +
         " " + name;
}

bool add_physical_name(const std::string& line, MeshParts& parts) {
  std::istringstream words(line);
  int dimension = 0, tag = 0;
  std::string name;
  if (!(words >> dimension >> tag) || !std::getline(words.ignore(1), name)) return false;
  parts.names[{dimension, tag}] = name;
  return true;
}

void require_no_polygons(const std::filesystem::path& path, const MeshView& mesh) {
  const Topology& topology = mesh.topology();
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    if (topology.cell_type(c) != ElementType::polygon) continue;
    std::vector<std::string> others;
    for (const auto& format : mesh_formats())
      if (format.holds_polygons) others.push_back(format.extension);
    throw InputError("cannot write " + path.string() + ": cell " + std::to_string(c) + " has " +
                     std::to_string(topology.cell_nodes(c).size()) + " nodes, and " +
                     path.extension().string() +
                     " files hold only triangles and quadrilaterals; use one of " + joined(others));
  }
}

namespace {

CompressedRows<NodeIndex> renumbered(const CompressedRows<NodeIndex>& rows,
                                     const std::vector<NodeIndex>& new_index) {
  CompressedRows<NodeIndex> result;
  std::vector<NodeIndex> nodes;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    nodes.clear();
    for (const NodeIndex node : rows[i]) nodes.push_back(new_index[node]);
    result.append(nodes);
  }
  return result;
}

}  // namespace

void renumber_nodes(MeshParts& parts, std::span<const NodeIndex> first) {
  std::vector<NodeIndex> new_index(parts.coordinates.size(), no_node);
  NodeIndex n_left = 0;
  for (std::size_t i = 0; i < new_index.size(); ++i) {
    if (first[i] == no_node) continue;
    if (first[i] != i) {
      new_index[i] = new_index[first[i]];
      if (parts.fixed && (*parts.fixed)[i]) (*parts.fixed)[new_index[i]] = true;
      continue;
    }
    new_index[i] = n_left;
    parts.coordinates[n_left] = parts.coordinates[i];
    if (parts.fixed) (*parts.fixed)[n_left] = (*parts.fixed)[i];
    if (!parts.node_ids.empty()) parts.node_ids[n_left] = parts.node_ids[i];
    ++n_left;
  }
  if (n_left == parts.coordinates.size()) return;
  parts.coordinates.resize(n_left);
  if (parts.fixed) parts.fixed->resize(n_left);
  if (!parts.node_ids.empty()) parts.node_ids.resize(n_left);
  for (int dim = 1; dim <= 3; ++dim)
    parts.elements[dim].nodes = renumbered(parts.elements[dim].nodes, new_index);
}

void drop_unused_nodes(MeshParts& parts) {
  std::vector<NodeIndex> first(parts.coordinates.size(), no_node);
  for (int dim = 1; dim <= 3; ++dim)
    for (const NodeIndex node : parts.elements[dim].nodes.entries()) first[node] = node;
  renumber_nodes(parts, first);
}

}  // namespace smoothfem
