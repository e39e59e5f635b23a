// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <set>
#include <utility>
#include <vector>

#include "smoothing/mesh/topology.h"

namespace smoothfem {

/// A node where u is a weighted mean of its values at other nodes.
struct NodeTie {
  NodeIndex node;
  std::vector<std::pair<NodeIndex, double>> masters;  ///< other nodes with their weights
};

/// Ties of nodes of a mesh: hanging nodes, and periodic partners. Default: none.
struct NodeTies {
  std::vector<NodeTie> nodes;  ///< by node; each once
  /// Boundary facets (their nodes, ascending) where parts of the mesh meet: no boundary values hold
  /// there.
  std::set<std::vector<NodeIndex>> inner_facets;

  bool empty() const { return nodes.empty(); }
};

/// Returns the ties of both with masters that are not tied themselves. Nodes of `first` take their
/// ties from there. Throws InputError if ties go in a circle.
NodeTies joined_ties(NodeTies first, const NodeTies& second);

}  // namespace smoothfem
