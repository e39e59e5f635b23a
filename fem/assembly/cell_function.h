// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <type_traits>

#include "fem/assembly/cell_integrals.h"

namespace smoothfem {

/// A finite element function on one cell, or on one cell in each lane.
template <int dim, std::size_t n_dofs, std::size_t n_vertices, class Real = double>
struct CellFunction {
  std::array<Vector<dim, Real>, n_vertices> vertices;
  std::array<Real, n_dofs> values;

  /// x: of the nodes; u: at the dofs.
  CellFunction(const ElementCells& group, std::size_t cell, const std::vector<Point<dim>>& x,
               const Eigen::VectorXd& u) requires(std::is_same_v<Real, double>)
      : vertices(cell_vertices<dim, n_vertices>(group, cell, x)) {
    for (std::size_t i = 0; i < n_dofs; ++i) values[i] = u[group.dofs[cell * n_dofs + i]];
  }

  CellFunction(const ElementCells& group, const std::array<std::size_t, n_lanes>& cells,
               const std::vector<Point<dim>>& x,
               const Eigen::VectorXd& u) requires(std::is_same_v<Real, Lanes>)
      : vertices(cell_vertices<dim, n_vertices>(group, cells, x)) {
    for (std::size_t i = 0; i < n_dofs; ++i)
      for (std::size_t l = 0; l < n_lanes; ++l) values[i][l] = u[group.dofs[cells[l] * n_dofs + i]];
  }

  MappedPoint<dim, Real> map(const QuadratureTable& table, std::size_t q) const {
    return map_point<dim, Real>(table, q, vertices);
  }

  Vector<dim, Real> slope(const QuadratureTable& table, std::size_t q,
                          const MappedPoint<dim, Real>& mapped) const {
    std::array<Real, dim> reference{};
    for (std::size_t i = 0; i < n_dofs; ++i)
      for (std::size_t d = 0; d < dim; ++d)
        reference[d] += values[i] * table.shape_gradient[dim * (q * n_dofs + i) + d];
    return mapped.jacobian.gradient(reference.data());
  }

  Point<dim> gradient(const QuadratureTable& table, std::size_t q,
                      const MappedPoint<dim, double>& mapped) const {
    return point_of(slope(table, q, mapped));
  }
};

/// Calls visit.operator()<n_dofs, n_vertices>(group, number of the group) for the groups of a space
/// without pyramids and prisms, and without curved cells.
template <int dim, class Visit>
void for_each_smooth_group(const FiniteElementSpace<dim>& space, const Visit& visit) {
  for_each_straight_group(
      space, [&]<std::size_t n_dofs, std::size_t n_vertices>(const ElementCells& group) {
        if constexpr (dim == 2 || (n_vertices != 5 && n_vertices != 6))
          visit.template operator()<n_dofs, n_vertices>(
              group, static_cast<std::size_t>(&group - space.groups.data()));
      });
}

}  // namespace smoothfem
