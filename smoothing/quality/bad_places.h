// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sstream>
#include <vector>

#include "smoothing/base/option_text.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {

/// Returns one flag for each node. Fixed are the fixed nodes of the topology, and all nodes that do
/// not belong to cells near a bad one. A bad cell has a mean ratio below q. Near it are the cell
/// itself and `rings` rings of cells around it (cells that share a node). Throws InputError if no
/// free node is left; the message says whether there are no bad cells or no free nodes near them.
template <int dim, int spacedim>
std::vector<bool> fixed_away_from_bad_cells(const Mesh<dim, spacedim>& mesh, double q, int rings) {
  const auto text = [](double number) {
    std::ostringstream stream;
    stream << number;
    return stream.str();
  };
  const Topology& topology = mesh.topology();
  const auto ratios = cell_mean_ratios(mesh);
  std::vector<CellIndex> cells;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    if (ratios[c] < q) cells.push_back(c);
  if (cells.empty())
    throw InputError("no cell has a mean ratio below " + text(q) +
                     ", so there is nothing to smooth; raise " + option_text("only-below"));
  std::vector<bool> fixed(mesh.n_nodes(), true);
  bool any_free = false;
  for (int ring = 0; ring <= rings; ++ring) {
    std::vector<NodeIndex> reached;
    for (const CellIndex c : cells)
      for (const NodeIndex i : topology.cell_nodes(c)) {
        if (!topology.is_fixed(i)) {
          fixed[i] = false;
          any_free = true;
        }
        reached.push_back(i);
      }
    if (ring < rings) cells = topology.cells_around(reached);
  }
  if (!any_free)
    throw InputError("no node near the cells with a mean ratio below " + text(q) +
                     " is free; free nodes by " + option_text("fix") + ", or use more " +
                     option_text("rings"));
  return fixed;
}

}  // namespace smoothfem
