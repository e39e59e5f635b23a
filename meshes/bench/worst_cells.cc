// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/bench/worst_cells.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "meshes/bench/memory_speed.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem::bench {

namespace {

/// Counts the cache lines of some arrays, each assumed to begin at one.
class Lines {
 public:
  /// Adds entries first .. first + n - 1 of an array of T.
  template <class T>
  void add(int array, std::size_t first, std::size_t n = 1) {
    for (std::size_t line = first * sizeof(T) / line_size;
         line * line_size < (first + n) * sizeof(T); ++line)
      lines_.emplace(array, line);
  }
  std::size_t size() const { return lines_.size(); }

 private:
  std::set<std::pair<int, std::size_t>> lines_;
};

/// Counts the cache lines of the cells around a cell: their numbers, nodes, coordinates, qualities,
/// and the keys that choose the next cell.
std::size_t n_lines_around(const Topology& topology, CellIndex cell) {
  enum Array { cells_of_nodes, nodes_of_cells, coordinates, qualities, keys };
  Lines lines;
  for (const NodeIndex node : topology.cell_nodes(cell)) {
    const auto around = topology.node_cells(node);
    lines.add<CellIndex>(cells_of_nodes,
                         static_cast<std::size_t>(around.data() - topology.node_cells(0).data()),
                         around.size());
  }
  for (const CellIndex c : topology.cells_around(topology.cell_nodes(cell))) {
    lines.add<NodeIndex>(nodes_of_cells, topology.cells().offset(c), topology.cell_nodes(c).size());
    for (const NodeIndex node : topology.cell_nodes(c)) lines.add<Point<3>>(coordinates, node);
    lines.add<double>(qualities, c);
    lines.add<double>(keys, c);
  }
  return lines.size();
}

}  // namespace

WorstCells worst_cells(const VolumeMesh& mesh) {
  constexpr std::size_t n_worst = 100;
  const Topology& topology = mesh.topology();
  const auto quality = cell_mean_ratios(mesh);
  std::vector<CellIndex> cells;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    if (topology.has_free_node(c)) cells.push_back(c);
  std::partial_sort(cells.begin(), cells.begin() + n_worst, cells.end(),
                    [&](CellIndex a, CellIndex b) { return quality[a] < quality[b]; });
  WorstCells result;
  for (std::size_t i = 0; i < n_worst; ++i) {
    const std::size_t n_around = topology.cells_around(topology.cell_nodes(cells[i])).size();
    result.n_touching += static_cast<double>(n_around - 1) / n_worst;
    result.n_lines += static_cast<double>(n_lines_around(topology, cells[i])) / n_worst;
  }
  result.n_bytes =
      static_cast<double>(2 * sizeof(NodeIndex) * topology.cells().n_entries() +
                          2 * sizeof(double) * mesh.n_cells() + sizeof(Point<3>) * mesh.n_nodes());
  return result;
}

}  // namespace smoothfem::bench
