#include <gmsh.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <unordered_map>

#include "meshes/io/gmsh_session.h"
#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/io/msh_file.h"
#include "smoothing/mesh/input_error.h"

namespace smoothfem {

namespace {

using NodeNumbers = std::unordered_map<std::size_t, NodeIndex>;

/// Elements of one dimension of the current Gmsh model, with what the model says about them.
struct GmshElements {
  std::vector<std::size_t> tags;
  CompressedRows<NodeIndex> nodes;
  std::vector<int> physical_tags;  ///< 0 without a group
};

int first_physical_tag(int dimension, int entity) {
  std::vector<int> tags;
  gmsh::model::getPhysicalGroupsForEntity(dimension, entity, tags);
  return tags.empty() ? 0 : tags.front();
}

void refuse_volumes() {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags, nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, 3);
  if (!types.empty())
    throw InputError("the mesh has volume elements; only planar meshes can be read");
}

/// Nodes in the order of their tags, so that the numbering does not depend on Gmsh's entities.
std::vector<Point<2>> planar_nodes(NodeNumbers& numbers) {
  std::vector<std::size_t> tags;
  std::vector<double> xyz, parameters;
  gmsh::model::mesh::getNodes(tags, xyz, parameters);
  if (tags.size() >= std::numeric_limits<NodeIndex>::max())
    throw InputError("the mesh has more nodes than 32 bits can count");
  std::vector<std::size_t> order(tags.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return tags[a] < tags[b]; });
  std::vector<Point<2>> coordinates;
  for (const std::size_t i : order) {
    numbers.emplace(tags[i], static_cast<NodeIndex>(coordinates.size()));
    coordinates.emplace_back(xyz[3 * i], xyz[3 * i + 1]);
    if (xyz[3 * i + 2] != xyz[2])
      throw InputError("node " + std::to_string(tags[i]) +
                       " has z = " + std::to_string(xyz[3 * i + 2]) + " and another node z = " +
                       std::to_string(xyz[2]) + "; only planar meshes with constant z can be read");
  }
  return coordinates;
}

/// Number of nodes of a straight-sided element type with corners only.
std::size_t n_corners(int type) {
  std::string name;
  int dimension = 0, order = 0, n_nodes = 0, n_primary = 0;
  std::vector<double> local;
  gmsh::model::mesh::getElementProperties(type, name, dimension, order, n_nodes, local, n_primary);
  if (n_nodes != n_primary || order > 1)
    throw InputError("the mesh has elements of type '" + name +
                     "' with nodes besides their corners; save it with element order 1");
  return static_cast<std::size_t>(n_nodes);
}

NodeIndex number_of(std::size_t node, std::size_t element, const NodeNumbers& numbers) {
  const auto found = numbers.find(node);
  if (found == numbers.end())
    throw InputError("element " + std::to_string(element) + " names node " + std::to_string(node) +
                     ", which the file does not have");
  return found->second;
}

GmshElements elements_of_dimension(int dimension, const NodeNumbers& numbers) {
  GmshElements result;
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities, dimension);
  for (const auto& [_, entity] : entities) {
    const int physical_tag = first_physical_tag(dimension, entity);
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, dimension, entity);
    for (std::size_t t = 0; t < types.size(); ++t) {
      const std::size_t n = n_corners(types[t]);
      std::vector<NodeIndex> row(n);
      for (std::size_t e = 0; e < tags[t].size(); ++e) {
        for (std::size_t k = 0; k < n; ++k)
          row[k] = number_of(nodes[t][e * n + k], tags[t][e], numbers);
        result.nodes.append(row);
        result.tags.push_back(tags[t][e]);
        result.physical_tags.push_back(physical_tag);
      }
    }
  }
  return result;
}

std::vector<std::size_t> order_by_tag(const GmshElements& elements) {
  std::vector<std::size_t> order(elements.tags.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return elements.tags[a] < elements.tags[b]; });
  return order;
}

void add_cells(const GmshElements& cells, const MshStructure& structure, MeshParts& parts) {
  const auto& tags = cells.physical_tags;
  const bool any_tag = std::any_of(tags.begin(), tags.end(), [](int tag) { return tag != 0; });
  for (const std::size_t c : order_by_tag(cells)) {
    parts.cells.append(cells.nodes[c]);
    if (any_tag) parts.labels.cell_tags.push_back(tags[c]);
    const auto line = structure.element_lines.find(cells.tags[c]);
    if (line != structure.element_lines.end()) parts.cell_lines.push_back(line->second);
  }
  if (parts.cell_lines.size() != parts.cells.size()) parts.cell_lines.clear();
}

void add_labels(const GmshElements& edges, MeshLabels& labels) {
  for (const std::size_t e : order_by_tag(edges)) {
    if (edges.physical_tags[e] == 0) continue;
    labels.facets.append(edges.nodes[e]);
    labels.facet_tags.push_back(edges.physical_tags[e]);
  }
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups);
  for (const auto& [dimension, tag] : groups) {
    if (dimension != 1 && dimension != 2) continue;
    std::string name;
    gmsh::model::getPhysicalName(dimension, tag, name);
    if (!name.empty()) labels.names[{dimension, tag}] = name;
  }
}

/// Gmsh skips what it cannot place without an error; the announced number tells.
void require_complete(const MshStructure& structure) {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags, nodes;
  gmsh::model::mesh::getElements(types, tags, nodes);
  std::size_t n_elements = 0;
  for (const auto& of_type : tags) n_elements += of_type.size();
  if (n_elements != structure.n_elements)
    throw InputError("the file announces " + std::to_string(structure.n_elements) +
                     " elements but " + std::to_string(n_elements) + " could be read");
}

}  // namespace

MeshFile read_msh(const std::filesystem::path& path) {
  const MshStructure structure = check_msh_structure(path, read_whole_file(path));
  MeshParts parts;
  const GmshSession session;
  session.run(path.string(), [&] { gmsh::merge(path.string()); });
  try {
    session.run(path.string(), [&] {
      require_complete(structure);
      refuse_volumes();
      NodeNumbers numbers;
      parts.coordinates = planar_nodes(numbers);
      add_cells(elements_of_dimension(2, numbers), structure, parts);
      add_labels(elements_of_dimension(1, numbers), parts.labels);
    });
  } catch (const InputError& error) {
    const std::string message = error.what();
    throw InputError(message.starts_with(path.string()) ? message : path.string() + ": " + message);
  }
  drop_unused_nodes(parts);
  return assemble_mesh(path, std::move(parts));
}

}  // namespace smoothfem
