// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/quality/layers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "smoothing/geometry/cell_size.h"
#include "smoothing/mesh/boundary_tags.h"
#include "smoothing/mesh/volume_elements.h"

namespace smoothfem {

namespace {

/// Length of an edge, or area of a face.
double size_of_facet(const PlanarMesh& mesh, std::span<const NodeIndex> nodes) {
  return (mesh.coordinates()[nodes[1]] - mesh.coordinates()[nodes[0]]).norm();
}
double size_of_facet(const VolumeMesh& mesh, std::span<const NodeIndex> nodes) {
  return 0.5 * smoothfem::area_vector(nodes, mesh.coordinates()).norm();
}

/// Calls use(nodes) for each facet of a cell.
template <class Use>
void for_each_facet_of(const Topology& topology, CellIndex cell, const Use& use) {
  const auto nodes = topology.cell_nodes(cell);
  std::vector<NodeIndex> facet;
  for_each_facet(topology.dimension(), nodes.size(), [&](std::span<const std::size_t> at) {
    facet.clear();
    for (const std::size_t k : at) facet.push_back(nodes[k]);
    use(std::span<const NodeIndex>(facet));
  });
}

template <int dim>
double largest_facet(const Mesh<dim>& mesh, CellIndex cell) {
  double largest = 0.0;
  for_each_facet_of(mesh.topology(), cell, [&](std::span<const NodeIndex> facet) {
    largest = std::max(largest, size_of_facet(mesh, facet));
  });
  return largest;
}

/// Calls use(cell) for the cells, one or two, that have all nodes of a facet.
template <class Use>
void for_each_cell_of_facet(const Topology& topology, std::span<const NodeIndex> facet,
                            const Use& use) {
  for (const CellIndex c : topology.node_cells(facet[0])) {
    const auto nodes = topology.cell_nodes(c);
    if (std::all_of(facet.begin(), facet.end(), [&](NodeIndex node) {
          return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
        }))
      use(c);
  }
}

/// True if a cell stands upright on its facet: all other nodes have about the same height above it,
/// and none is far off its side. Cells of a layer do; most thin cells of a distorted mesh do not.
template <int dim>
bool stands_upright(const Mesh<dim>& mesh, CellIndex cell, std::span<const NodeIndex> facet) {
  constexpr double max_height_ratio = 2.0, max_offset = 0.75;
  const auto x = mesh.coordinates();
  Point<dim> middle = Point<dim>::Zero(), normal;
  for (const NodeIndex i : facet) middle += x[i] / static_cast<double>(facet.size());
  if constexpr (dim == 2)
    normal = Point<2>(x[facet[0]].y() - x[facet[1]].y(), x[facet[1]].x() - x[facet[0]].x());
  else
    normal = smoothfem::area_vector(facet, x);
  normal.normalize();
  double width = 0.0;
  for (const NodeIndex i : facet) width = std::max(width, 2.0 * (x[i] - middle).norm());
  double lowest = std::numeric_limits<double>::infinity(), highest = 0.0;
  for (const NodeIndex i : mesh.topology().cell_nodes(cell)) {
    if (std::find(facet.begin(), facet.end(), i) != facet.end()) continue;
    const Point<dim> offset = x[i] - middle;
    const double height = std::abs(offset.dot(normal));
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
    if ((offset - offset.dot(normal) * normal).norm() > max_offset * width) return false;
  }
  return highest <= max_height_ratio * lowest;
}

}  // namespace

template <int dim>
double cell_aspect(const Mesh<dim>& mesh, CellIndex cell) {
  const auto nodes = mesh.topology().cell_nodes(cell);
  double longest = 0.0;
  for_each_edge(dim, nodes.size(), [&](std::size_t a, std::size_t b) {
    longest =
        std::max(longest, (mesh.coordinates()[nodes[a]] - mesh.coordinates()[nodes[b]]).norm());
  });
  const ElementType type = mesh.topology().cell_type(cell);
  const bool ends_in_point = type == ElementType::triangle || type == ElementType::tetrahedron ||
                             type == ElementType::pyramid;
  const double height = (ends_in_point ? dim : 1) * std::abs(signed_cell_size(mesh, cell)) /
                        largest_facet(mesh, cell);
  return height > 0.0 ? longest / height : std::numeric_limits<double>::infinity();
}

template <int dim>
Layers find_layers(const Mesh<dim>& mesh, const std::set<int>& tags) {
  const Topology& topology = mesh.topology();
  std::vector<bool> is_thin(mesh.n_cells());
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    is_thin[c] = cell_aspect(mesh, c) > min_layer_aspect;
  Layers layers;
  std::vector<CellIndex>& found = layers.cells;
  const auto add = [&](CellIndex c) {
    if (!is_thin[c]) return false;
    is_thin[c] = false;  // only once
    found.push_back(c);
    return true;
  };
  constexpr double nearly_largest = 0.5,  // both bases of a prism may be slightly different
      least_share = 0.1;  // of the facets with a label; fewer thin cells are no layer
  const auto of_facets = boundary_tags(topology);
  const auto& boundary = topology.boundary_facets();
  std::map<int, std::pair<std::size_t, std::vector<CellIndex>>> by_tag;  // facets, cells on them
  for (std::size_t f = 0; f < boundary.size(); ++f) {
    const int tag = of_facets.empty() ? 0 : of_facets[f];
    if (!tags.empty() && !tags.contains(tag)) continue;
    auto& [n_facets, cells] = by_tag[tag];
    ++n_facets;
    for_each_cell_of_facet(topology, boundary[f], [&, &cells = cells](CellIndex c) {
      if (is_thin[c] && stands_upright(mesh, c, boundary[f]) &&
          size_of_facet(mesh, boundary[f]) >= nearly_largest * largest_facet(mesh, c))
        cells.push_back(c);
    });
  }
  for (const auto& [tag, on_facets] : by_tag) {
    const auto& [n_facets, cells] = on_facets;
    if (static_cast<double>(cells.size()) < least_share * static_cast<double>(n_facets)) continue;
    for (const CellIndex c : cells) add(c);
    if (!cells.empty()) layers.tags.insert(tag);
  }
  for (std::size_t k = 0; k < found.size(); ++k)
    for_each_facet_of(topology, found[k], [&](std::span<const NodeIndex> facet) {
      for_each_cell_of_facet(topology, facet, add);
    });
  std::sort(found.begin(), found.end());
  return layers;
}

template double cell_aspect(const Mesh<2>&, CellIndex);
template double cell_aspect(const Mesh<3>&, CellIndex);
template Layers find_layers(const Mesh<2>&, const std::set<int>&);
template Layers find_layers(const Mesh<3>&, const std::set<int>&);

}  // namespace smoothfem
