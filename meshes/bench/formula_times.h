// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem::bench {

/// Time in seconds of the bare formulas of the methods, for cells of a mesh that fits the innermost
/// cache. As in any method, nodes are looked up by their numbers. No table is stored, nothing is
/// decided, and all lanes are full.
struct FormulaTimes {
  double neighbour;    ///< adds one position to the sum of a node's neighbours
  double centroid;     ///< adds a cell's centroid, weighted by its size, to a node's sum
  double mean_ratio;   ///< of a cell
  double transformed;  ///< adds a cell's nodes, transformed by GETMe simultaneous, to the sums of
                       ///< the nodes
  double transformed_alone;  ///< transforms one cell alone
  double weight;  ///< adds one quality to the weight of a cell by its neighbours (GETMe adaptive)
  double objective;    ///< evaluates the objective of global optimization for a cell
  double derivatives;  ///< evaluates its gradient and Hessian for a cell, all pairs of nodes
  double product;      ///< multiplies a block of the Hessian with a vector
};

/// Measures the first cells of a mesh, which must be all tetrahedra or all hexahedra.
FormulaTimes formula_times(const VolumeMesh& mesh);

}  // namespace smoothfem::bench
