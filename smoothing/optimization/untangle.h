// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "smoothing/mesh/mesh.h"
#include "smoothing/optimization/sliding_nodes.h"

namespace smoothfem {

struct UntangleParameters {
  /// Rounds of sweeps, each on a larger neighbourhood of the invalid cells and with a slower
  /// descent of the softness; most meshes need one, what five do not cure more do not either.
  int max_rounds = 5;
  /// Sweeps of the first round; each round has twice as many as the one before.
  int sweeps = 25;
  /// Softness (in terms of the mean |det(S)| round a node) at the beginning of a round: much larger
  /// than any determinant, so that a node goes to a mean of its neighbours.
  double first_softness = 10.0;
  /// Softness at the end of a round: small enough that inverted corners do not pay.
  double last_softness = 1e-3;
};

struct UntangleResult {
  bool valid = false;                ///< whether the mesh is valid now
  std::size_t n_invalid_before = 0;  ///< cells
  std::size_t n_invalid_after = 0;   ///< cells, in the best mesh that was found
  /// Invalid cells of that mesh, ascending: empty if it is valid.
  std::vector<CellIndex> invalid_cells;
  /// Invalid cells without a free node: nothing can make them valid as long as it has none. If
  /// there are any nothing is tried.
  std::vector<CellIndex> fully_fixed_cells;
  int n_sweeps = 0;
  double seconds = 0.0;
};

/// Makes a tangled mesh valid by moving its free nodes, where it can. A valid mesh stays as it is,
/// and so does one that could not be made valid. Minimizes the shape objective with determinants
/// replaced by a positive, ever sharper bound of theirs (Escobar et al., Simultaneous untangling
/// and smoothing of tetrahedral meshes, Comput. Methods Appl. Mech. Engrg. 192 (2003)), node after
/// node, round the invalid cells; when all cells are valid some sweeps for the shape objective
/// itself take them away from the edge of validity. Needs no start that is anything like valid. The
/// same bits for every number of threads, the same result at every scale. dim = 2 or 3.
///
/// sliding: free nodes that stay on the boundary; of a volume mesh with constraints
/// (with_sliding_boundary) they follow from these unless given. They go along it, and facets stay
/// within their distance of the initial boundary: steps beyond are not taken.
template <int dim>
UntangleResult untangle(Mesh<dim>& mesh, const UntangleParameters& parameters = {},
                        const SlidingNodes<dim>* sliding = nullptr);

}  // namespace smoothfem
