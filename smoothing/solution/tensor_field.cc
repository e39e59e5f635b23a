// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/solution/tensor_field.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

namespace smoothfem {

namespace {

template <int dim>
using Corners = std::array<std::uint8_t, dim + 1>;

/// Returns the simplices into which a cell with n nodes is divided.
std::span<const Corners<2>> simplices(std::size_t n, std::integral_constant<int, 2>) {
  static constexpr std::array<Corners<2>, 2> all{{{0, 1, 2}, {0, 2, 3}}};
  return {all.data(), n - 2};
}
std::span<const Corners<3>> simplices(std::size_t n, std::integral_constant<int, 3>) {
  static constexpr std::array<Corners<3>, 1> tetrahedron{{{0, 1, 2, 3}}};
  static constexpr std::array<Corners<3>, 6> hexahedron{
      {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}}};
  if (n == 4) return tetrahedron;
  return hexahedron;
}

}  // namespace

template <int dim>
struct TensorField<dim>::Place {
  std::array<NodeIndex, dim + 1> nodes{};
  Eigen::Matrix<double, dim, dim> inverse;  ///< inverse matrix of the edges from the first node
  Eigen::Matrix<double, dim + 1, 1> barycentric;            ///< coordinates of the point
  double depth = -std::numeric_limits<double>::infinity();  ///< the lowest of them

  bool is_inside() const {
    constexpr double rounding = 1e-10;
    return depth >= -rounding;
  }
};

template <int dim>
TensorField<dim>::TensorField(const Mesh<dim>& mesh, std::span<const CellTensor<dim>> of_cells,
                              std::span<const double> sizes)
    : topology_(mesh.shared_topology()),
      x_(mesh.copied_coordinates()),
      at_nodes_(mesh.n_nodes(), CellTensor<dim>::Identity()) {
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    CellTensor<dim> sum = CellTensor<dim>::Zero();
    double total = 0.0;
    for (const CellIndex c : topology_->node_cells(i)) {
      sum += sizes[c] * of_cells[c];
      total += sizes[c];
    }
    if (total > 0.0) at_nodes_[i] = sum / total;
  }
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto nodes = topology_->cell_nodes(c);
    Point<dim> sum = Point<dim>::Zero();
    for (const NodeIndex i : nodes) sum += x_[i];
    centroids_.push_back(sum / static_cast<double>(nodes.size()));
  }
}

/// Locates the point in the simplex of the cell in which it is deepest.
template <int dim>
auto TensorField<dim>::place_in(const Point<dim>& point, CellIndex cell) const -> Place {
  Place best;
  const auto nodes = topology_->cell_nodes(cell);
  for (const auto& simplex : simplices(nodes.size(), std::integral_constant<int, dim>{})) {
    Place place;
    Eigen::Matrix<double, dim, dim> edges;
    for (int k = 0; k <= dim; ++k) place.nodes[k] = nodes[simplex[k]];
    for (int k = 0; k < dim; ++k) edges.col(k) = x_[place.nodes[k + 1]] - x_[place.nodes[0]];
    place.inverse = edges.inverse();
    place.barycentric.template tail<dim>() = place.inverse * (point - x_[place.nodes[0]]);
    place.barycentric[0] = 1.0 - place.barycentric.template tail<dim>().sum();
    place.depth = place.barycentric.minCoeff();
    if (place.depth > best.depth)
      best = place;  // a simplex without size has depth NaN and is never chosen
  }
  return best;
}

/// Goes from cell to cell around the nodes of the last one, as long as their centroids come nearer.
template <int dim>
auto TensorField<dim>::find(const Point<dim>& point, CellIndex& cell) const -> Place {
  Place here = place_in(point, cell);
  while (!here.is_inside()) {
    CellIndex nearest = cell;
    for (const NodeIndex i : topology_->cell_nodes(cell))
      for (const CellIndex c : topology_->node_cells(i)) {
        const Place there = place_in(point, c);
        if (there.is_inside()) {
          cell = c;
          return there;
        }
        if ((centroids_[c] - point).squaredNorm() < (centroids_[nearest] - point).squaredNorm())
          nearest = c;
      }
    if (nearest == cell) break;
    cell = nearest;
    here = place_in(point, cell);
  }
  return here;
}

template <int dim>
auto TensorField<dim>::at(const Point<dim>& point, CellIndex& cell) const -> Value {
  Value value{.tensor = CellTensor<dim>::Zero(), .derivatives = {}};
  for (auto& derivative : value.derivatives) derivative.setZero();
  Place place = find(point, cell);
  if (!place.is_inside()) {
    place.barycentric = place.barycentric.cwiseMax(0.0);
    place.barycentric /= place.barycentric.sum();
  }
  for (int k = 0; k <= dim; ++k) value.tensor += place.barycentric[k] * at_nodes_[place.nodes[k]];
  for (int k = 1; k <= dim; ++k)
    for (int d = 0; d < dim; ++d)
      value.derivatives[d] +=
          place.inverse(k - 1, d) * (at_nodes_[place.nodes[k]] - at_nodes_[place.nodes[0]]);
  return value;
}

template class TensorField<2>;
template class TensorField<3>;

}  // namespace smoothfem
