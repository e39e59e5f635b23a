// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmsh.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/io/msh_file.h"
#include "meshes/tools/gmsh_session.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

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

std::vector<std::size_t> ascending(const std::vector<std::size_t>& tags) {
  std::vector<std::size_t> order(tags.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return tags[a] < tags[b]; });
  return order;
}

/// Nodes in the order of their tags, so that the numbering does not depend on Gmsh's entities.
void add_nodes(MeshParts& parts) {
  std::vector<std::size_t> tags;
  std::vector<double> xyz, parameters;
  gmsh::model::mesh::getNodes(tags, xyz, parameters);
  for (const std::size_t i : ascending(tags)) {
    parts.node_ids.push_back(tags[i]);
    parts.coordinates.emplace_back(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
  }
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

/// node_tags: ascending.
NodeIndex number_of(std::size_t node, std::size_t element,
                    const std::vector<std::size_t>& node_tags) {
  const auto found = node - 1 < node_tags.size() && node_tags[node - 1] == node
                         ? node_tags.begin() + static_cast<std::ptrdiff_t>(node - 1)
                         : std::lower_bound(node_tags.begin(), node_tags.end(), node);
  if (found == node_tags.end() || *found != node)
    throw InputError("element " + std::to_string(element) + " names node " + std::to_string(node) +
                     ", which the file does not have");
  return static_cast<NodeIndex>(found - node_tags.begin());
}

GmshElements elements_of_dimension(int dimension, const std::vector<std::size_t>& node_tags) {
  GmshElements result;
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities, dimension);
  std::vector<NodeIndex> row;
  for (const auto& [_, entity] : entities) {
    const int physical_tag = first_physical_tag(dimension, entity);
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, dimension, entity);
    for (std::size_t t = 0; t < types.size(); ++t) {
      const std::size_t n = n_corners(types[t]);
      row.resize(n);
      for (std::size_t e = 0; e < tags[t].size(); ++e) {
        for (std::size_t k = 0; k < n; ++k)
          row[k] = number_of(nodes[t][e * n + k], tags[t][e], node_tags);
        result.nodes.append(row);
        result.tags.push_back(tags[t][e]);
        result.physical_tags.push_back(physical_tag);
      }
    }
  }
  return result;
}

void add_elements(const GmshElements& found, const MshStructure& structure, ElementList& elements) {
  for (const std::size_t e : ascending(found.tags)) {
    elements.nodes.append(found.nodes[e]);
    elements.tags.push_back(found.physical_tags[e]);
    elements.ids.push_back(found.tags[e]);
    const auto line = structure.element_lines.find(found.tags[e]);
    if (line != structure.element_lines.end()) elements.lines.push_back(line->second);
  }
  if (elements.lines.size() != elements.nodes.size()) elements.lines.clear();
}

void add_names(MeshParts& parts) {
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups);
  for (const auto& [dimension, tag] : groups) {
    std::string name;
    gmsh::model::getPhysicalName(dimension, tag, name);
    if (!name.empty()) parts.names[{dimension, tag}] = name;
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
      add_nodes(parts);
      for (int dimension = 1; dimension <= 3; ++dimension)
        add_elements(elements_of_dimension(dimension, parts.node_ids), structure,
                     parts.elements[dimension]);
      add_names(parts);
    });
  } catch (const InputError& error) {
    const std::string message = error.what();
    throw InputError(message.starts_with(path.string()) ? message : path.string() + ": " + message);
  }
  drop_unused_nodes(parts);
  return assemble_mesh(path, std::move(parts));
}

}  // namespace smoothfem
