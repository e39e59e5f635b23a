// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "fem/cell_integrals.h"

namespace smoothfem {

/// A finite element function on one cell.
template <int dim, std::size_t n_dofs, std::size_t n_vertices>
struct CellFunction {
  std::array<Vector<dim, double>, n_vertices> vertices;
  std::array<double, n_dofs> values;

  /// x: of the nodes; u: at the dofs.
  CellFunction(const ElementCells& group, std::size_t cell, const std::vector<Point<dim>>& x,
               const Eigen::VectorXd& u)
      : vertices(cell_vertices<dim, n_vertices>(group, cell, x)) {
    for (std::size_t i = 0; i < n_dofs; ++i) values[i] = u[group.dofs[cell * n_dofs + i]];
  }

  MappedPoint<dim, double> map(const QuadratureTable& table, std::size_t q) const {
    return map_point<dim, double>(table, q, vertices);
  }

  Point<dim> gradient(const QuadratureTable& table, std::size_t q,
                      const MappedPoint<dim, double>& mapped) const {
    std::array<double, dim> reference{};
    for (std::size_t i = 0; i < n_dofs; ++i)
      for (std::size_t d = 0; d < dim; ++d)
        reference[d] += values[i] * table.shape_gradient[dim * (q * n_dofs + i) + d];
    return point_of(mapped.jacobian.gradient(reference.data()));
  }
};

/// Calls visit.operator()<n_dofs, n_vertices>(group, number of the group) for the groups of a space
/// without pyramids and prisms.
template <int dim, class Visit>
void for_each_smooth_group(const FiniteElementSpace<dim>& space, const Visit& visit) {
  for_each_group(space, [&]<std::size_t n_dofs, std::size_t n_vertices>(const ElementCells& group) {
    if constexpr (dim == 2 || (n_vertices != 5 && n_vertices != 6))
      visit.template operator()<n_dofs, n_vertices>(
          group, static_cast<std::size_t>(&group - space.groups.data()));
  });
}

}  // namespace smoothfem
