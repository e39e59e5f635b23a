// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/solution/mesh_functional.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "smoothing/base/parallel.h"
#include "smoothing/mesh/volume_elements.h"

namespace smoothfem {

namespace {

constexpr double theta = 1.0 / 3.0, p = 1.5;  // values of Huang and Kamenski
constexpr std::size_t grain = 256;

/// Calls visit(corners, share) for the simplices of a planar cell with n nodes.
template <class Visit>
void for_each_simplex(std::size_t n, std::integral_constant<int, 2>, const Visit& visit) {
  if (n == 3) return visit(std::array<std::size_t, 3>{0, 1, 2}, 1.0);
  for (std::size_t k = 0; k < n; ++k)
    visit(std::array<std::size_t, 3>{k, (k + 1) % n, (k + n - 1) % n}, 0.5);
}
/// Calls visit(corners, share) for the simplices of a volume cell with n nodes.
template <class Visit>
void for_each_simplex(std::size_t n, std::integral_constant<int, 3>, const Visit& visit) {
  if (n == 4) return visit(std::array<std::size_t, 4>{0, 1, 2, 3}, 1.0);
  constexpr double share = 0.75;  // eight with a sixth of the cell each
  for (const LocalSimplex& corner : VolumeElement<8>::corners)
    visit(std::array<std::size_t, 4>{corner[0], corner[1], corner[2], corner[3]}, share);
}

}  // namespace

template <int dim>
MeshFunctional<dim>::MeshFunctional(const Mesh<dim>& reference) {
  const Topology& topology = reference.topology();
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    const auto nodes = topology.cell_nodes(c);
    for_each_simplex(nodes.size(), std::integral_constant<int, dim>{},
                     [&](const auto& corners, double share) {
                       Simplex simplex{.nodes = {}, .share = share, .reference = {}};
                       for (std::size_t k = 0; k <= dim; ++k) simplex.nodes[k] = nodes[corners[k]];
                       simplex.reference = edges(simplex, reference.coordinates());
                       simplices_.push_back(simplex);
                       first_cells_.push_back(c);
                     });
  }
  terms_.resize(simplices_.size());
}

template <int dim>
void MeshFunctional<dim>::set_metric(TensorField<dim> metric) {
  metric_ = std::make_unique<const TensorField<dim>>(std::move(metric));
  cells_ = first_cells_;
}

template <int dim>
auto MeshFunctional<dim>::edges(const Simplex& simplex, std::span<const Point<dim>> x) -> Matrix {
  Matrix columns;
  for (int k = 0; k < dim; ++k) columns.col(k) = x[simplex.nodes[k + 1]] - x[simplex.nodes[0]];
  return columns;
}

template <int dim>
auto MeshFunctional<dim>::term(std::size_t k, std::span<const Point<dim>> x) -> Term {
  constexpr double factorial = dim == 2 ? 2.0 : 6.0, exponent = 0.5 * dim * p;
  const double constant = (1.0 - 2.0 * theta) * std::pow(dim, exponent);
  const Simplex& simplex = simplices_[k];
  const Matrix e = edges(simplex, x);
  const double size = simplex.share * e.determinant() / factorial;
  if (!(size > 0.0)) return {.value = std::numeric_limits<double>::infinity()};
  Point<dim> centroid = Point<dim>::Zero();
  for (const NodeIndex i : simplex.nodes) centroid += x[i] / (dim + 1.0);
  const auto metric = metric_->at(centroid, cells_[k]);

  const Matrix inverse = e.inverse(), j = simplex.reference * inverse;
  const Matrix m_inverse = metric.tensor.inverse(), j_m = j * m_inverse;
  const double density = std::sqrt(metric.tensor.determinant());
  const double trace = j_m.cwiseProduct(j).sum();
  const double alignment = theta * density * std::pow(trace, exponent);
  const double distribution = constant * density * std::pow(j.determinant() / density, p);
  const double g = alignment + distribution;
  const double by_trace = exponent * alignment / trace;  // dG / d tr(J M^-1 J^T)

  Term result{.value = size * g};
  // dJ = -J dE E^-1, d det J = -det J tr(E^-1 dE), d|K| = |K| tr(E^-1 dE)
  const Matrix by_e =
      (g - p * distribution) * Matrix::Identity() - 2.0 * by_trace * (j.transpose() * j_m);
  result.by_edges = size * (by_e * inverse.transpose());
  const Matrix by_m = (0.5 * alignment + 0.5 * (1.0 - p) * distribution) * m_inverse -
                      by_trace * (j_m.transpose() * j_m);
  for (int d = 0; d < dim; ++d)
    result.by_centroid[d] = size * by_m.cwiseProduct(metric.derivatives[d]).sum();
  return result;
}

template <int dim>
double MeshFunctional<dim>::value(const Mesh<dim>& mesh) {
  const auto x = mesh.coordinates();
  parallel_for_ranges(simplices_.size(), grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) terms_[k] = term(k, x);
  });
  double sum = 0.0;
  gradient_.assign(mesh.n_nodes(), Point<dim>::Zero());
  for (std::size_t k = 0; k < simplices_.size(); ++k) {
    const Term& term = terms_[k];
    const auto& nodes = simplices_[k].nodes;
    sum += term.value;
    for (const NodeIndex i : nodes) gradient_[i] += term.by_centroid / (dim + 1.0);
    for (int d = 0; d < dim; ++d) gradient_[nodes[d + 1]] += term.by_edges.col(d);
    gradient_[nodes[0]] -= term.by_edges.rowwise().sum();
  }
  return sum;
}

template class MeshFunctional<2>;
template class MeshFunctional<3>;

}  // namespace smoothfem
