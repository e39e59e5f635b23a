// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <vector>

#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// Numbers of sets of physical groups. Cells in the same groups are of one material.
class MaterialNumbers {
 public:
  /// Returns the number of a set, in any order. A set that is not known gets the next number.
  int of(std::vector<int> groups);
  /// Of all known sets, ascending.
  const std::map<std::vector<int>, int>& all() const { return numbers_; }

 private:
  std::map<std::vector<int>, int> numbers_;
};

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
