#pragma once

#include <memory>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// The same mesh with nodes and cells in an order in which neighbours lie near each other in
/// memory: nodes by the reverse Cuthill-McKee algorithm (Cuthill and McKee, Proc. 24th ACM Nat.
/// Conf., 1969), cells by their first node, those of one type together where that costs little.
/// Smoothing large meshes takes half the time of that in a mesh generator's order.
template <int dim>
class Reordering {
 public:
  explicit Reordering(const Topology& topology);

  /// A mesh of the topology given, in the new order.
  Mesh<dim> apply(const Mesh<dim>& mesh) const;
  /// Sets the coordinates of a mesh in the old order to those of one in the new order.
  void restore(const std::vector<Point<dim>>& reordered, std::vector<Point<dim>>& result) const;

 private:
  std::vector<NodeIndex> node_order_;  ///< old index of each node in the new order
  std::shared_ptr<const Topology> topology_;
};

}  // namespace smoothfem
