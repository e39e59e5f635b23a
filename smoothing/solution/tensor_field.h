// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "smoothing/loop/problem.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A field of symmetric tensors in space, on the cells of a mesh as it is now: linear on simplices
/// between values at the nodes. Quadrilaterals are divided into two, hexahedra into six around a
/// diagonal. Any number of threads may ask at a time.
template <int dim>
class TensorField {
 public:
  struct Value {
    CellTensor<dim> tensor;
    std::array<CellTensor<dim>, dim> derivatives;  ///< along each coordinate
  };

  /// of_cells: the value at a node is the mean over the cells around it, weighted by their sizes.
  TensorField(const Mesh<dim>& mesh, std::span<const CellTensor<dim>> of_cells,
              std::span<const double> sizes);

  /// The search begins in `cell`, which becomes the one where the point was found. Outside of the
  /// domain the value is that of the boundary nearby.
  Value at(const Point<dim>& point, CellIndex& cell) const;

 private:
  struct Place;  ///< a simplex of a cell, and where a point lies in it
  Place place_in(const Point<dim>& point, CellIndex cell) const;
  Place find(const Point<dim>& point, CellIndex& cell) const;

  std::shared_ptr<const Topology> topology_;
  std::vector<Point<dim>> x_, centroids_;
  std::vector<CellTensor<dim>> at_nodes_;
};

}  // namespace smoothfem
