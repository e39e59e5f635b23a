// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem::bench {

/// Seconds that the bare formulas of the methods take for cells of a mesh that is small enough for
/// the innermost cache: nodes are looked up by their numbers, as any method has to, but no table is
/// kept, nothing is decided, and all lanes are full.
struct FormulaTimes {
  double neighbour;    ///< one position added to the sum of a node's neighbours
  double centroid;     ///< of a cell, weighted by its size, added to a node's sum
  double mean_ratio;   ///< of a cell
  double transformed;  ///< a cell's nodes by GETMe simultaneous, added to the sums of the nodes
  double transformed_alone;  ///< those of one cell by itself
  double weight;             ///< of a cell by its neighbours (GETMe adaptive): one quality added
  double objective;          ///< of global optimization: of a cell
  double derivatives;        ///< its gradient and Hessian of a cell, all pairs of nodes
  double product;            ///< of a block of the Hessian with a vector
};

/// For the first cells of a mesh, which all have to be tetrahedra or all hexahedra.
FormulaTimes formula_times(const VolumeMesh& mesh);

}  // namespace smoothfem::bench
