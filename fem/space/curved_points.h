// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "fem/space/finite_element_space.h"
#include "smoothing/mesh/midside_nodes.h"

namespace smoothfem {

/// Returns the position of a substitute point. points: of earlier local points.
template <int dim>
Point<dim> weighted_sum(const SubstitutePoint& sum, const std::vector<Point<dim>>& points) {
  Point<dim> position = Point<dim>::Zero();
  for (const auto& [point, weight] : sum) position += weight * points[point];
  return position;
}

/// Numbers the local points of a space on a mesh of second order: finds the midside nodes and makes
/// substitute points where there are none. Cells that share an edge or a face share its point, also
/// if only one of them has a node there. So the mapped cells fit together.
template <int dim>
class CurvedPoints {
 public:
  /// topology: on the root, null elsewhere. Adds midside nodes to the nodes of the space. Fills
  /// curved_points of its groups if it is curved, otherwise the points of its boundary dofs.
  /// Collective.
  CurvedPoints(const Topology* topology, FiniteElementSpace<dim>& space);

  /// Appends the points of the mapping of a facet of this rank's cells. vertices: local nodes in
  /// the order of `mapping`.
  void append_facet(const MappingPoints& mapping, std::span<const NodeIndex> vertices,
                    std::vector<NodeIndex>& points);

 private:
  /// The place of an edge or a face in the mesh, or the number of a cell, followed by no_corner.
  using Key = MidsidePlace;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::size_t hash = 0;
      for (const NodeIndex number : key) hash = (hash ^ number) * 0x9e3779b97f4a7c15U;
      return hash ^ (hash >> 32U);
    }
  };
  using Map = std::unordered_map<Key, NodeIndex, Hash>;

  static Key key_of(std::vector<NodeIndex> corners);
  Key key_in_cell(const ElementCells& group, std::size_t cell,
                  const std::vector<std::size_t>& place) const;
  static std::vector<NodeIndex> midside_nodes_by_key(const Topology& topology);
  void find_nodes(const Map& of_mesh);
  /// Appends the points of the mapping of a cell.
  void append_cell(const ElementCells& group, std::size_t cell, const MappingPoints& mapping,
                   std::vector<NodeIndex>& points);
  /// Finds the points of the boundary dofs of a straight-sided space.
  void find_boundary_points(const ElementCells& group, const MappingPoints& mapping);
  void append(const MappingPoints& mapping, std::size_t k, const Key& key,
              std::vector<NodeIndex>& points);

  FiniteElementSpace<dim>& space_;
  std::vector<MappingPoints> mappings_;  ///< of the curved cells of each group
  Map points_;                           ///< local points of edges, faces and cells
};

}  // namespace smoothfem
