// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// Returns the physical groups of a cell, ascending. Cells are of one material if they are in the
/// same groups. entity: of the model; 0: the file has none.
std::vector<int> material_groups(const FileContent* content, int dimension, int entity, int tag);

/// Returns a number for each cell; cells have the same one if they are in the same physical groups.
/// Empty if all cells are.
std::vector<int> cell_materials(const Topology& topology);

/// Facets that a file sets apart inside a mesh: between cells of different materials, and labelled
/// ones.
struct Interfaces {
  /// Neighbours run alike: those with a side in common that no third facet has.
  CompressedRows<NodeIndex> facets;
  std::vector<int> tags;  ///< tag of a label; 0: none
};
Interfaces inner_interfaces(const Topology& topology);

/// Returns flags of the nodes that a file sets apart: those between cells of different materials,
/// also if these share a node only; those of labelled inner facets; those of labelled edges of a
/// volume mesh that are not part of its boundary; labelled points. Empty if there are none.
std::vector<bool> interface_nodes(const Topology& topology);

/// Returns flags of the nodes that are labelled points. Empty if there are none.
std::vector<bool> labelled_points(const Topology& topology);

/// Returns flags of the nodes of elements that the file requires, as Medit files do: the point
/// fields 'required' and 'corner', and the element fields 'required' and 'ridge'. Empty if there
/// are none.
std::vector<bool> required_nodes(const Topology& topology);

/// Names of the fields of required_nodes().
inline constexpr const char *required_field = "required", *corner_field = "corner",
                            *ridge_field = "ridge";

}  // namespace smoothfem
