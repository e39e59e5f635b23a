// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem::bench {

/// Data that GETMe sequential reads around its first cells, averaged over these cells.
struct WorstCells {
  double n_touching = 0.0;  ///< cells that share a node with it
  double n_lines = 0.0;     ///< cache lines with the data of it and of these cells
  double n_bytes = 0.0;     ///< bytes of these data for all cells, which span these lines
};

/// Averages over the cells of the lowest quality that have a free node.
WorstCells worst_cells(const VolumeMesh& mesh);

}  // namespace smoothfem::bench
