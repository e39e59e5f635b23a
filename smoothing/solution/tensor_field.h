// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "smoothing/loop/problem.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A field of symmetric tensors on the cells of a mesh in its present state: linear on simplices
/// between values at the nodes. Quadrilaterals are divided into two simplices, hexahedra into six
/// around a diagonal. May be used by several threads at a time.
template <int dim>
class TensorField {
 public:
  struct Value {
    CellTensor<dim> tensor;
    std::array<CellTensor<dim>, dim> derivatives;  ///< along each coordinate
  };

  /// of_cells: tensors of the cells. The value at a node is the mean over the cells around it,
  /// weighted by their sizes.
  TensorField(const Mesh<dim>& mesh, std::span<const CellTensor<dim>> of_cells,
              std::span<const double> sizes);

  /// Returns the value at a point. The search begins in `cell`, which becomes the cell where the
  /// point was found. Outside of the domain the value is that of the boundary nearby.
  Value at(const Point<dim>& point, CellIndex& cell) const;

 private:
  struct Place;  ///< a simplex of a cell, and the position of a point in it
  Place place_in(const Point<dim>& point, CellIndex cell) const;
  Place find(const Point<dim>& point, CellIndex& cell) const;

  std::shared_ptr<const Topology> topology_;
  std::vector<Point<dim>> x_, centroids_;
  std::vector<CellTensor<dim>> at_nodes_;
};

}  // namespace smoothfem
