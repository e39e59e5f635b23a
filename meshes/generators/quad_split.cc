#include "meshes/generators/quad_split.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "smoothing/quality/mean_ratio.h"

namespace smoothfem {

namespace {

using Edge = std::pair<NodeIndex, NodeIndex>;

/// Quadrilaterals that are not convex, cut at the diagonal that leaves two valid triangles.
CompressedRows<NodeIndex> without_invalid(const PlanarCells& mesh) {
  CompressedRows<NodeIndex> cells;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto row = mesh.cells[c];
    const auto corner = [&](std::size_t k) { return mesh.coordinates[row[k % row.size()]]; };
    std::size_t reflex = row.size();
    for (std::size_t k = 0; k < row.size(); ++k)
      if (!(cross(corner(k + 1) - corner(k), corner(k + 3) - corner(k)) > 0.0)) reflex = k;
    if (row.size() != 4 || reflex == row.size()) {
      cells.append(row);
      continue;
    }
    for (const std::size_t first : {reflex, reflex + 2})
      cells.append(std::array{row[first % 4], row[(first + 1) % 4], row[(first + 2) % 4]});
  }
  return cells;
}

class Splitting {
 public:
  Splitting(const PlanarCells& mesh, const CompressedRows<NodeIndex>& cells) : cells_(cells) {
    result_.coordinates = mesh.coordinates;
    for (std::size_t c = 0; c < cells.size(); ++c)
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

PlanarCells split_to_quadrilaterals(
    const PlanarCells& mesh,
    const std::function<Point<2>(NodeIndex, NodeIndex)>& boundary_midpoint) {
  const CompressedRows<NodeIndex> cells = without_invalid(mesh);
  return Splitting(mesh, cells).split(boundary_midpoint);
}

}  // namespace smoothfem
