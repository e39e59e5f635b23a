// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem::bench {

/// What GETMe sequential has to look at around the cells that it takes first, of each on average.
struct WorstCells {
  double n_touching = 0.0;  ///< cells that share a node with it
  double n_lines = 0.0;     ///< lines of memory that hold what is needed of it and of these
  double n_bytes = 0.0;     ///< the same of all cells: where these lines are
};

/// Those of the lowest quality of all that have a free node.
WorstCells worst_cells(const VolumeMesh& mesh);

}  // namespace smoothfem::bench
