// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/quad_split.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <utility>

#include "smoothing/quality/mean_ratio.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {

namespace {

using Edge = std::pair<NodeIndex, NodeIndex>;

class Splitting {
 public:
  explicit Splitting(const PlanarCells& mesh) : cells_(mesh.cells) {
    result_.coordinates = mesh.coordinates;
    for (std::size_t c = 0; c < cells_.size(); ++c)
      for_each_edge(c, [&](Edge edge) { ++n_cells_[sorted(edge)]; });
  }

  PlanarCells split(const std::function<Point<2>(NodeIndex, NodeIndex)>& boundary_midpoint) {
    for (std::size_t c = 0; c < cells_.size(); ++c)
      for_each_edge(c, [&](Edge edge) {
        const auto& [a, b] = edge;
        if (middle_.contains(sorted(edge))) return;
        const bool given = boundary_midpoint && n_cells_[sorted(edge)] == 1;
        middle_[sorted(edge)] =
            add(given ? boundary_midpoint(a, b)
                      : Point<2>(0.5 * (result_.coordinates[a] + result_.coordinates[b])));
      });
    for (std::size_t c = 0; c < cells_.size(); ++c) split_cell(c);
    return std::move(result_);
  }

 private:
  static Edge sorted(const Edge& edge) { return std::minmax(edge.first, edge.second); }

  template <class Function>
  void for_each_edge(std::size_t cell, const Function& function) const {
    const auto row = cells_[cell];
    for (std::size_t k = 0; k < row.size(); ++k) function(Edge{row[k], row[(k + 1) % row.size()]});
  }

  NodeIndex add(const Point<2>& point) {
    result_.coordinates.push_back(point);
    return static_cast<NodeIndex>(result_.coordinates.size() - 1);
  }

  void split_cell(std::size_t cell) {
    const auto row = cells_[cell];
    const std::size_t n = row.size();
    Point<2> sum = Point<2>::Zero();
    for (const NodeIndex node : row) sum += result_.coordinates[node];
    const NodeIndex centre = add(sum / static_cast<double>(n));
    for (std::size_t k = 0; k < n; ++k)
      result_.cells.append(std::array{row[k], middle_.at(sorted({row[k], row[(k + 1) % n]})),
                                      centre, middle_.at(sorted({row[(k + n - 1) % n], row[k]}))});
  }

  const CompressedRows<NodeIndex>& cells_;
  std::map<Edge, int> n_cells_;
  std::map<Edge, NodeIndex> middle_;
  PlanarCells result_;
};

}  // namespace

void cut_quadrilaterals(PlanarCells& mesh, const std::vector<Diagonal>& diagonals) {
  CompressedRows<NodeIndex> cells;
  for (CellIndex c = 0; c < mesh.cells.size(); ++c) {
    const auto row = mesh.cells[c];
    if (!diagonals[c]) {
      cells.append(row);
      continue;
    }
    for (const std::size_t first : {*diagonals[c], *diagonals[c] + 2})
      cells.append(std::array{row[first % 4], row[(first + 1) % 4], row[(first + 2) % 4]});
  }
  mesh.cells = std::move(cells);
}

void cut_invalid_quadrilaterals(PlanarCells& mesh) {
  std::vector<Diagonal> diagonals(mesh.cells.size());
  for (CellIndex c = 0; c < mesh.cells.size(); ++c) {
    const auto row = mesh.cells[c];
    const auto corner = [&](std::size_t k) { return mesh.coordinates[row[k % 4]]; };
    for (std::size_t k = 0; row.size() == 4 && k < 4; ++k)
      if (!(cross(corner(k + 1) - corner(k), corner(k + 3) - corner(k)) > 0.0)) diagonals[c] = k;
  }
  cut_quadrilaterals(mesh, diagonals);
}

void cut_worst_quadrilaterals(PlanarCells& mesh, std::size_t n) {
  const std::vector<double> ratios = cell_mean_ratios(PlanarMesh(
      std::make_shared<const Topology>(2, mesh.coordinates.size(), mesh.cells), mesh.coordinates));
  std::vector<CellIndex> worst;
  for (CellIndex c = 0; c < mesh.cells.size(); ++c)
    if (mesh.cells[c].size() == 4) worst.push_back(c);
  std::stable_sort(worst.begin(), worst.end(),
                   [&](CellIndex a, CellIndex b) { return ratios[a] < ratios[b]; });
  std::vector<Diagonal> diagonals(mesh.cells.size());
  for (std::size_t i = 0; i < std::min(n, worst.size()); ++i) {
    const auto row = mesh.cells[worst[i]];
    const auto length = [&](std::size_t k) {
      return (mesh.coordinates[row[k]] - mesh.coordinates[row[k + 2]]).norm();
    };
    diagonals[worst[i]] = length(0) <= length(1) ? 0 : 1;
  }
  cut_quadrilaterals(mesh, diagonals);
}

PlanarCells split_to_quadrilaterals(
    const PlanarCells& mesh,
    const std::function<Point<2>(NodeIndex, NodeIndex)>& boundary_midpoint) {
  PlanarCells valid = mesh;
  cut_invalid_quadrilaterals(valid);
  return Splitting(valid).split(boundary_midpoint);
}

}  // namespace smoothfem
