// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sstream>
#include <vector>

#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {

/// One flag a node: fixed are those that the topology says, and those that no cell near a bad one
/// has. Bad is a mean ratio below q; near are the bad cells themselves and as many rings of cells
/// around them (cells that share a node) as asked for. Throws InputError if no free node is left,
/// saying which it is: no bad cells, or none that a free node could mend.
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
                     ", so nothing is to be smoothed; raise --only-below");
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
                     " is free; free some by --fix, or take more --rings");
  return fixed;
}

}  // namespace smoothfem
