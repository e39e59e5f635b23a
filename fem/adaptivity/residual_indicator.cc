// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/adaptivity/residual_indicator.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fem/assembly/cell_function.h"
#include "smoothing/base/parallel.h"

namespace smoothfem {

namespace {

constexpr std::size_t grain = 256;
constexpr std::uint32_t none = UINT32_MAX;

/// Vertices of a cell's facets, in deal.II's order of vertices. Those of a face run around it; a
/// triangle repeats its last one.
using LocalFacet = std::array<std::uint8_t, 4>;

std::span<const LocalFacet> local_facets(ElementType type) {
  static constexpr std::array<LocalFacet, 3> triangle{{{0, 1, 1, 1}, {1, 2, 2, 2}, {2, 0, 0, 0}}};
  static constexpr std::array<LocalFacet, 4> quadrilateral{
      {{0, 1, 1, 1}, {1, 3, 3, 3}, {3, 2, 2, 2}, {2, 0, 0, 0}}};
  static constexpr std::array<LocalFacet, 4> tetrahedron{
      {{0, 1, 2, 2}, {0, 1, 3, 3}, {0, 2, 3, 3}, {1, 2, 3, 3}}};
  static constexpr std::array<LocalFacet, 6> hexahedron{
      {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
  switch (type) {
    case ElementType::triangle:
      return triangle;
    case ElementType::quadrilateral:
      return quadrilateral;
    case ElementType::tetrahedron:
      return tetrahedron;
    default:
      return hexahedron;
  }
}

/// A facet of one of its cells.
struct CellFacet {
  std::array<NodeIndex, 4> nodes;   ///< around it; shorter facets repeat the last one
  std::array<NodeIndex, 4> sorted;  ///< equal for both cells
  std::size_t group, cell, number;  ///< of the cell: in its group and among all
};

/// |F| n, in either direction.
Point<2> area_vector(const std::array<NodeIndex, 4>& nodes, const std::vector<Point<2>>& x) {
  const Point<2> along = x[nodes[1]] - x[nodes[0]];
  return {along.y(), -along.x()};
}
Point<3> area_vector(const std::array<NodeIndex, 4>& nodes, const std::vector<Point<3>>& x) {
  return 0.5 * (x[nodes[2]] - x[nodes[0]]).cross(x[nodes[3]] - x[nodes[1]]);
}

template <class Nodes, class PointType>
double diameter(const Nodes& nodes, const std::vector<PointType>& x) {
  double largest = 0.0;
  for (const NodeIndex i : nodes)
    for (const NodeIndex j : nodes) largest = std::max(largest, (x[i] - x[j]).norm());
  return largest;
}

/// Weight of a facet's dof in the integral over the facet, whose size is 1. Exact for polynomials
/// of degree 1; for elements of degree 2, exact for squares of their gradients on the facet.
/// n_nodes: of the facet; n_of_dof: number of nodes whose mean is the dof's position.
double facet_weight(int degree, std::size_t n_nodes, std::size_t n_of_dof) {
  if (degree == 1) return 1.0 / static_cast<double>(n_nodes);
  if (n_nodes == 3) return n_of_dof == 1 ? 0.0 : 1.0 / 3.0;
  const double along_edge = n_of_dof == 1 ? 1.0 / 6.0 : 2.0 / 3.0;  // Simpson's rule
  if (n_nodes == 2) return along_edge;
  return n_of_dof == 1 ? 1.0 / 36.0 : n_of_dof == 2 ? 1.0 / 9.0 : 4.0 / 9.0;
}

/// The indicators of one solution.
template <int dim>
class Residuals {
 public:
  Residuals(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
            const Eigen::VectorXd& u, const ManufacturedSolution<dim>& solution)
      : space_(space), x_(x), u_(u), solution_(solution) {}

  std::vector<double> indicators() {
    add_cells();
    add_jumps();
    for (std::size_t c = 0; c < squares_.size(); ++c)
      squares_[c] = std::sqrt(squares_[c] / sizes_[c] / scales_[c]);
    return std::move(squares_);
  }

 private:
  /// Adds h_K^2 |f + div A grad u|^2, and computes A grad u at the dofs for the jumps.
  void add_cells() {
    fluxes_.resize(space_.groups.size());
    for_each_smooth_group(space_, [&]<std::size_t n_dofs, std::size_t n_vertices>(
                                      const ElementCells& group, std::size_t g) {
      const std::size_t before = squares_.size();
      const auto at_dofs = make_support_table(group.element.type, space_.degree);
      fluxes_[g].resize(group.n_cells() * n_dofs);
      squares_.resize(before + group.n_cells());
      sizes_.resize(squares_.size());
      scales_.resize(squares_.size());
      parallel_for_ranges(group.n_cells(), grain, [&](std::size_t first, std::size_t last) {
        for (std::size_t cell = first; cell < last; ++cell) {
          const CellFunction<dim, n_dofs, n_vertices> function(group, cell, x_, u_);
          Point<dim>* fluxes = &fluxes_[g][cell * n_dofs];
          double scale = 0.0;
          for (std::size_t i = 0; i < n_dofs; ++i)
            fluxes[i] = flux(function.map(at_dofs, i), function, at_dofs, i, scale);
          const std::span nodes(&group.vertices[cell * n_vertices], n_vertices);
          scales_[before + cell] = scale / static_cast<double>(n_dofs);
          const double h = diameter(nodes, x_);
          squares_[before + cell] =
              h * h *
              squared_residual(group.element.errors, function, fluxes, sizes_[before + cell]);
        }
      });
    });
  }

  template <std::size_t n_dofs, std::size_t n_vertices>
  double squared_residual(const QuadratureTable& table,
                          const CellFunction<dim, n_dofs, n_vertices>& function,
                          const Point<dim>* fluxes, double& size) const {
    double sum = 0.0;
    size = 0.0;
    for (std::size_t q = 0; q < table.n_points; ++q) {
      const auto mapped = function.map(table, q);
      double divergence = 0.0;
      for (std::size_t i = 0; i < n_dofs; ++i)
        divergence += fluxes[i].dot(
            point_of(mapped.jacobian.gradient(&table.shape_gradient[dim * (q * n_dofs + i)])));
      const double residual = solution_.load(point_of(mapped.position)) + divergence;
      sum += mapped.weight * residual * residual;
      size += mapped.weight;
    }
    return sum;
  }

  /// Returns A grad u at a dof; adds the mean eigenvalue of A to `scale`.
  template <std::size_t n_dofs, std::size_t n_vertices>
  Point<dim> flux(const MappedPoint<dim, double>& mapped,
                  const CellFunction<dim, n_dofs, n_vertices>& function,
                  const QuadratureTable& at_dofs, std::size_t i, double& scale) const {
    const Point<dim> gradient = function.gradient(at_dofs, i, mapped);
    if (!solution_.diffusivity) {
      scale += 1.0;
      return gradient;
    }
    const Diffusivity<dim> a = solution_.diffusivity(point_of(mapped.position));
    scale += a.trace() / dim;
    return a * gradient;
  }

  /// Returns all facets; the two sides of inner ones are adjacent.
  std::vector<CellFacet> facets() const {
    std::vector<CellFacet> all;
    std::size_t number = 0;
    for (std::size_t g = 0; g < space_.groups.size(); ++g) {
      const ElementCells& group = space_.groups[g];
      for (std::size_t cell = 0; cell < group.n_cells(); ++cell, ++number)
        for (const LocalFacet& local : local_facets(group.element.type)) {
          CellFacet facet{.nodes = {}, .sorted = {}, .group = g, .cell = cell, .number = number};
          for (std::size_t k = 0; k < local.size(); ++k)
            facet.nodes[k] = group.vertices[cell * group.element.n_vertices + local[k]];
          facet.sorted = facet.nodes;
          std::sort(facet.sorted.begin(), facet.sorted.end());
          // Removes repeated nodes: the two cells need not repeat the same one.
          const auto end = std::unique(facet.sorted.begin(), facet.sorted.end());
          std::fill(end, facet.sorted.end(), none);
          all.push_back(facet);
        }
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const CellFacet& a, const CellFacet& b) { return a.sorted < b.sorted; });
    return all;
  }

  void add_jumps() {
    const auto all = facets();
    for (std::size_t k = 0; k + 1 < all.size(); ++k)
      if (all[k].sorted == all[k + 1].sorted) {
        const double half = 0.5 * diameter(all[k].nodes, x_) * squared_jump(all[k], all[k + 1]);
        squares_[all[k].number] += half;
        squares_[all[k + 1].number] += half;
      }
  }

  /// Integral of [A grad u . n]^2.
  double squared_jump(const CellFacet& here, const CellFacet& there) const {
    const Point<dim> area = area_vector(here.nodes, x_);
    const auto end = std::find(here.sorted.begin(), here.sorted.end(), none);
    const auto n_nodes = static_cast<std::size_t>(end - here.sorted.begin());
    const auto is_on_facet = [&](std::uint32_t dof) {
      const auto nodes = space_.dof_nodes[dof];
      return std::all_of(nodes.begin(), nodes.end(), [&](NodeIndex i) {
        return std::find(here.sorted.begin(), end, i) != end;
      });
    };
    double sum = 0.0;
    const auto dofs = dofs_of(here);
    for (std::size_t i = 0; i < dofs.size(); ++i)
      if (is_on_facet(dofs[i])) {
        const double jump = area.dot(flux_at(here, dofs[i]) - flux_at(there, dofs[i]));
        sum += facet_weight(space_.degree, n_nodes, space_.dof_nodes[dofs[i]].size()) * jump * jump;
      }
    return sum / area.norm();
  }

  std::span<const std::uint32_t> dofs_of(const CellFacet& facet) const {
    const ElementCells& group = space_.groups[facet.group];
    const std::size_t n_dofs = group.element.n_dofs;
    return {&group.dofs[facet.cell * n_dofs], n_dofs};
  }

  const Point<dim>& flux_at(const CellFacet& facet, std::uint32_t dof) const {
    const auto dofs = dofs_of(facet);
    const auto i = std::find(dofs.begin(), dofs.end(), dof) - dofs.begin();
    return fluxes_[facet.group][facet.cell * dofs.size() + static_cast<std::size_t>(i)];
  }

  const FiniteElementSpace<dim>& space_;
  const std::vector<Point<dim>>& x_;
  const Eigen::VectorXd& u_;
  const ManufacturedSolution<dim>& solution_;
  std::vector<std::vector<Point<dim>>> fluxes_;   ///< of each group, at the dofs of each cell
  std::vector<double> squares_, sizes_, scales_;  ///< of each cell
};

}  // namespace

template <int dim>
std::vector<double> residual_indicators(const FiniteElementSpace<dim>& space,
                                        const std::vector<Point<dim>>& x, const Eigen::VectorXd& u,
                                        const ManufacturedSolution<dim>& solution) {
  return Residuals<dim>(space, x, u, solution).indicators();
}

template std::vector<double> residual_indicators(const FiniteElementSpace<2>&,
                                                 const std::vector<Point<2>>&,
                                                 const Eigen::VectorXd&,
                                                 const ManufacturedSolution<2>&);
template std::vector<double> residual_indicators(const FiniteElementSpace<3>&,
                                                 const std::vector<Point<3>>&,
                                                 const Eigen::VectorXd&,
                                                 const ManufacturedSolution<3>&);

}  // namespace smoothfem
