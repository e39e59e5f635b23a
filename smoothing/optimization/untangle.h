// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

struct UntangleParameters {
  /// Number of rounds of sweeps. Each round takes a larger neighbourhood of the invalid cells and
  /// lowers the softness more slowly. Most meshes need one; more than five rounds repair nothing
  /// more.
  int max_rounds = 5;
  /// Sweeps of the first round; each later round has twice as many as the previous one.
  int sweeps = 25;
  /// Softness (relative to the mean |det(S)| around a node) at the beginning of a round. It is much
  /// larger than any determinant, so that a node moves to a mean of its neighbours.
  double first_softness = 10.0;
  /// Softness at the end of a round; small enough that inverted corners raise the objective.
  double last_softness = 1e-3;
};

struct UntangleResult {
  bool valid = false;                ///< true if the mesh is valid now
  std::size_t n_invalid_before = 0;  ///< cells
  std::size_t n_invalid_after = 0;   ///< cells, in the best mesh found
  /// Invalid cells of that mesh, ascending; empty if it is valid.
  std::vector<CellIndex> invalid_cells;
  /// Invalid cells without a free node: they cannot become valid unless a node is freed. If there
  /// are any, nothing is tried.
  std::vector<CellIndex> fully_fixed_cells;
  int n_sweeps = 0;
  double seconds = 0.0;
};

/// Makes a tangled mesh valid by moving its free nodes, if it can. A valid mesh stays unchanged,
/// and so does one that cannot be made valid. dim = 2 or 3.
///
/// Minimizes the shape objective node after node around the invalid cells. Determinants are
/// replaced by a positive bound that gets sharper. Source: Escobar et al., Simultaneous untangling
/// and smoothing of tetrahedral meshes, Comput. Methods Appl. Mech. Engrg. 192 (2003). When all
/// cells are valid, a few sweeps for the shape objective itself move them away from invalidity. The
/// initial mesh may be arbitrarily tangled. Results are bitwise identical for every number of
/// threads, and the same at every scale.
///
/// Nodes that the mesh's constraints (with_sliding_boundary) keep on its boundary move along it.
/// Facets keep their distance from the initial boundary: steps beyond it are not taken.
template <int dim>
UntangleResult untangle(Mesh<dim>& mesh, const UntangleParameters& parameters = {});

}  // namespace smoothfem
