// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/space/curved_points.h"

#include <algorithm>

namespace smoothfem {

bool has_curved_cells(const Topology& topology, Geometry geometry) {
  return geometry == Geometry::curved && topology.midside() != nullptr &&
         topology.midside()->of_cells.n_entries() > 0;
}

template <int dim>
typename CurvedPoints<dim>::Key CurvedPoints<dim>::key_of(std::vector<NodeIndex> corners) {
  std::sort(corners.begin(), corners.end());
  Key key;
  key.fill(no_corner);
  std::copy(corners.begin(), corners.end(), key.begin());
  return key;
}

/// Returns the keys of all midside nodes of a mesh, each followed by its node. Nodes of edges and
/// faces are repeated.
template <int dim>
std::vector<NodeIndex> CurvedPoints<dim>::midside_nodes_by_key(const Topology& topology) {
  std::vector<NodeIndex> numbers;
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    const auto corners = topology.cell_nodes(c), nodes = topology.midside_nodes(c);
    const auto counts = midside_counts(dim, corners.size(), nodes.size());
    std::size_t position = 0;
    for_each_midside_place(dim, corners, nodes, [&](const Key& place, NodeIndex node) {
      const Key key = position++ < counts.edges + counts.faces ? place : key_of({c});
      numbers.insert(numbers.end(), key.begin(), key.end());
      numbers.push_back(node);
    });
  }
  return numbers;
}

template <int dim>
typename CurvedPoints<dim>::Key CurvedPoints<dim>::key_in_cell(
    const ElementCells& group, std::size_t cell, const std::vector<std::size_t>& place) const {
  const std::size_t n_vertices = group.element.n_vertices;
  if (place.size() == n_vertices) return key_of({group.numbers[cell]});
  std::vector<NodeIndex> corners;
  for (const std::size_t v : place)
    corners.push_back(space_.nodes[group.vertices[cell * n_vertices + v]]);
  return key_of(std::move(corners));
}

/// Finds the local numbers of the midside nodes on this rank's cells. One process has all nodes of
/// the mesh, with their numbers.
template <int dim>
void CurvedPoints<dim>::find_nodes(const Map& of_mesh) {
  if (space_.ranks.size() == 1) {
    points_ = of_mesh;
    return;
  }
  for (std::size_t g = 0; g < mappings_.size(); ++g) {
    const ElementCells& group = space_.groups[g];
    for (std::size_t cell = 0; cell < group.n_cells(); ++cell)
      for (std::size_t k = group.element.n_vertices; k < mappings_[g].size(); ++k) {
        const Key key = key_in_cell(group, cell, mappings_[g].places[k]);
        const auto found = of_mesh.find(key);
        if (found != of_mesh.end() &&
            points_.emplace(key, static_cast<NodeIndex>(space_.nodes.size())).second)
          space_.nodes.push_back(found->second);
      }
  }
}

/// Appends the k-th point of a cell or facet, whose earlier points are the last ones of the list.
template <int dim>
void CurvedPoints<dim>::append(const MappingPoints& mapping, std::size_t k, const Key& key,
                               std::vector<NodeIndex>& points) {
  const auto [found, is_new] = points_.emplace(
      key, static_cast<NodeIndex>(space_.nodes.size() + space_.substitute_points.size()));
  if (is_new) {
    auto& sum = space_.substitute_points.emplace_back();
    for (const auto& [earlier, weight] : mapping.substitutes[k])
      sum.emplace_back(points[points.size() - k + earlier], weight);
  }
  points.push_back(found->second);
}

template <int dim>
CurvedPoints<dim>::CurvedPoints(const Topology* topology, FiniteElementSpace<dim>& space)
    : space_(space) {
  std::vector<NodeIndex> numbers;
  if (topology != nullptr) numbers = midside_nodes_by_key(*topology);
  space.ranks.broadcast(numbers);
  Map of_mesh;
  for (std::size_t i = 0; i < numbers.size(); i += 5)
    of_mesh[{numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]}] = numbers[i + 4];
  for (const auto& group : space.groups)
    mappings_.push_back(mapping_points(dim, group.element.n_vertices, true));
  find_nodes(of_mesh);
  for (std::size_t g = 0; g < mappings_.size(); ++g) {
    ElementCells& group = space.groups[g];
    if (!space.is_curved)
      find_boundary_points(group, mappings_[g]);
    else
      for (std::size_t cell = 0; cell < group.n_cells(); ++cell)
        append_cell(group, cell, mappings_[g], group.curved_points);
  }
}

template <int dim>
void CurvedPoints<dim>::append_cell(const ElementCells& group, std::size_t cell,
                                    const MappingPoints& mapping, std::vector<NodeIndex>& points) {
  const std::size_t n_vertices = group.element.n_vertices;
  const auto first = group.vertices.begin() + static_cast<std::ptrdiff_t>(cell * n_vertices);
  points.insert(points.end(), first, first + static_cast<std::ptrdiff_t>(n_vertices));
  for (std::size_t k = n_vertices; k < mapping.size(); ++k)
    append(mapping, k, key_in_cell(group, cell, mapping.places[k]), points);
}

template <int dim>
void CurvedPoints<dim>::find_boundary_points(const ElementCells& group,
                                             const MappingPoints& mapping) {
  const auto& element = group.element;
  std::vector<std::size_t> points_of_dofs;
  for (std::size_t i = 0; i < element.n_dofs; ++i)
    points_of_dofs.push_back(mapping.find(element.vertices_around(i)));
  std::vector<NodeIndex> points;
  for (std::size_t cell = 0; cell < group.n_cells(); ++cell) {
    const auto* dofs = &group.dofs[cell * element.n_dofs];
    if (std::none_of(dofs, dofs + element.n_dofs,
                     [&](std::uint32_t dof) { return space_.is_given(dof); }))
      continue;
    points.clear();
    append_cell(group, cell, mapping, points);
    for (std::size_t i = 0; i < element.n_dofs; ++i)
      if (space_.is_given(dofs[i]) && element.vertices_around(i).size() > 1)
        space_.boundary_points.emplace_back(dofs[i], points[points_of_dofs[i]]);
  }
}

template <int dim>
void CurvedPoints<dim>::append_facet(const MappingPoints& mapping,
                                     std::span<const NodeIndex> vertices,
                                     std::vector<NodeIndex>& points) {
  points.insert(points.end(), vertices.begin(), vertices.end());
  for (std::size_t k = vertices.size(); k < mapping.size(); ++k) {
    std::vector<NodeIndex> corners;
    for (const std::size_t v : mapping.places[k]) corners.push_back(space_.nodes[vertices[v]]);
    append(mapping, k, key_of(std::move(corners)), points);
  }
}

template class CurvedPoints<2>;
template class CurvedPoints<3>;

}  // namespace smoothfem
