// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/assembly/best_approximation.h"

#include <cmath>

#include "fem/assembly/add_cell.h"
#include "fem/assembly/cell_integrals.h"

namespace smoothfem {

namespace {

using OneLane = std::array<double, 1>;  // add_cell takes the cells of several lanes

/// A cell's inner products of its shape functions (upper triangle row by row), and of them with u.
template <std::size_t n_dofs>
struct CellProducts {
  std::array<OneLane, n_dofs*(n_dofs + 1) / 2> stiffness{};
  std::array<OneLane, n_dofs> load{};
  std::array<double, n_dofs> scales{};  ///< integrals of the absolute values of the load's

  template <int dim, std::size_t n_vertices>
  CellProducts(const QuadratureTable& table,
               const std::array<Vector<dim, double>, n_vertices>& vertices,
               const ManufacturedSolution<dim>& solution, Norm norm) {
    const double of_gradients = norm == Norm::h1 ? 1.0 : 0.0;
    const auto add = [&](std::size_t q, const auto& mapped, const ValueAndGradient<dim>& u) {
      const auto gradient_of_u = vector_of(u.gradient);
      const double* shape = &table.shape[q * n_dofs];
      std::array<Vector<dim, double>, n_dofs> gradients;
      for (std::size_t i = 0; i < n_dofs; ++i)
        gradients[i] = mapped.jacobian.gradient(&table.shape_gradient[dim * (q * n_dofs + i)]);
      for (std::size_t i = 0, p = 0; i < n_dofs; ++i) {
        const double product =
            mapped.weight * (shape[i] * u.value + of_gradients * dot(gradients[i], gradient_of_u));
        load[i][0] += product;
        scales[i] += std::abs(product);
        for (std::size_t j = i; j < n_dofs; ++j, ++p)
          stiffness[p][0] += mapped.weight *
                             (shape[i] * shape[j] + of_gradients * dot(gradients[i], gradients[j]));
      }
    };
    for_each_point(table, vertices, solution.value_and_gradient, add);
  }

  /// True if a finer rule changes matrix and load little.
  bool is_near(const CellProducts& finer, double tolerance) const {
    double matrix_change = 0.0, matrix_square = 0.0, load_change = 0.0, load_square = 0.0;
    const auto squared = [](double value) { return value * value; };
    for (std::size_t p = 0; p < stiffness.size(); ++p) {
      matrix_change += squared(finer.stiffness[p][0] - stiffness[p][0]);
      matrix_square += squared(finer.stiffness[p][0]);
    }
    for (std::size_t i = 0; i < n_dofs; ++i) {
      load_change += squared(finer.load[i][0] - load[i][0]);
      load_square += squared(finer.scales[i]);
    }
    return matrix_change <= squared(tolerance) * matrix_square &&
           load_change <= squared(tolerance) * load_square;
  }
};

}  // namespace

template <int dim>
void assemble_projection(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
                         const ManufacturedSolution<dim>& solution, Norm norm,
                         PoissonSystem& system) {
  system.exact = space.values_at_dofs(solution.value, x, space.dof_points(x));
  system.matrix.coeffs().setZero();
  system.right_hand_side.setZero();
  for_each_group(space, [&]<std::size_t n_dofs, std::size_t n_vertices>(const ElementCells& group) {
    for (std::size_t cell = 0; cell < group.n_cells(); ++cell) {
      const auto vertices = cell_vertices<dim, n_vertices>(group, cell, x);
      const Settled<CellProducts<n_dofs>> products(
          group.element, [&](const QuadratureTable& table) {
            return CellProducts<n_dofs>(table, vertices, solution, norm);
          });
      add_cell<dim, n_dofs>(space, group, cell, products.integrals, 0, system);
    }
  });
}

template void assemble_projection(const FiniteElementSpace<2>&, const std::vector<Point<2>>&,
                                  const ManufacturedSolution<2>&, Norm, PoissonSystem&);
template void assemble_projection(const FiniteElementSpace<3>&, const std::vector<Point<3>>&,
                                  const ManufacturedSolution<3>&, Norm, PoissonSystem&);

}  // namespace smoothfem
