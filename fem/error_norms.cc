// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/error_norms.h"

#include <cmath>

#include "fem/cell_integrals.h"

namespace smoothfem {

namespace {

/// Integrals over cells of squares: of a function's values and of its gradients.
struct SquareSums {
  double values = 0.0;
  double gradients = 0.0;

  template <class Gradient>
  void add(double weight, double value, const Gradient& gradient) {
    values += weight * value * value;
    gradients += weight * squared_length(gradient);
  }
};

/// A finite element function's value and gradient at a mapped point.
template <int dim>
struct FunctionAtPoint {
  double value = 0.0;
  Vector<dim, double> gradient;

  template <std::size_t n_dofs>
  FunctionAtPoint(const std::array<double, n_dofs>& coefficients, const double* shape,
                  const double* shape_gradient, const MappedPoint<dim, double>& mapped) {
    std::array<double, dim> reference{};
    for (std::size_t i = 0; i < n_dofs; ++i) {
      value += coefficients[i] * shape[i];
      for (int d = 0; d < dim; ++d) reference[d] += coefficients[i] * shape_gradient[dim * i + d];
    }
    gradient = mapped.jacobian.gradient(reference.data());
  }
};

/// The cells of one element. nodal: of I_h u - u_h; true_error: of u - u_h.
template <int dim, std::size_t n_dofs, std::size_t n_vertices>
void add_cells(const ElementCells& group, const std::vector<Point<dim>>& x,
               const ManufacturedSolution<dim>& solution, const Eigen::VectorXd& exact,
               const Eigen::VectorXd& discrete, SquareSums& nodal, SquareSums& true_error) {
  const QuadratureTable& table = group.element.errors;
  for (std::size_t cell = 0; cell < group.n_own; ++cell) {
    const auto vertices = cell_vertices<dim, n_vertices>(group, cell, x);
    std::array<double, n_dofs> difference, approximation;
    for (std::size_t i = 0; i < n_dofs; ++i) {
      const std::uint32_t dof = group.dofs[cell * n_dofs + i];
      difference[i] = exact[dof] - discrete[dof];
      approximation[i] = discrete[dof];
    }
    for (std::size_t q = 0; q < table.n_points; ++q) {
      const auto mapped = map_point<dim, double>(table, q, vertices);
      const double* shape = &table.shape[q * n_dofs];
      const double* shape_gradient = &table.shape_gradient[dim * q * n_dofs];
      const FunctionAtPoint<dim> e_h(difference, shape, shape_gradient, mapped);
      const FunctionAtPoint<dim> u_h(approximation, shape, shape_gradient, mapped);
      const auto u = solution.value_and_gradient(point_of(mapped.position));
      nodal.add(mapped.weight, e_h.value, e_h.gradient);
      true_error.add(mapped.weight, u.value - u_h.value, vector_of(u.gradient) - u_h.gradient);
    }
  }
}

}  // namespace

template <int dim>
ErrorNorms error_norms(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
                       const ManufacturedSolution<dim>& solution, const Eigen::VectorXd& exact,
                       const Eigen::VectorXd& discrete) {
  const auto n_own = static_cast<Eigen::Index>(space.n_own);
  const auto errors = (exact.head(n_own) - discrete.head(n_own)).cwiseAbs();
  SquareSums nodal, true_error;
  for_each_group(space, [&]<std::size_t n_dofs, std::size_t n_vertices>(const ElementCells& group) {
    add_cells<dim, n_dofs, n_vertices>(group, x, solution, exact, discrete, nodal, true_error);
  });
  std::array sums{errors.sum(), nodal.values, nodal.gradients, true_error.values,
                  true_error.gradients};
  space.ranks.sum(sums);
  return {.e_max = space.ranks.max(n_own > 0 ? errors.maxCoeff() : 0.0),
          .e_mean = sums[0] / static_cast<double>(space.n_free),
          .e_l2 = std::sqrt(sums[1]),
          .e_h1 = std::sqrt(sums[1] + sums[2]),
          .l2_error = std::sqrt(sums[3]),
          .h1_error = std::sqrt(sums[3] + sums[4])};
}

template ErrorNorms error_norms(const FiniteElementSpace<2>&, const std::vector<Point<2>>&,
                                const ManufacturedSolution<2>&, const Eigen::VectorXd&,
                                const Eigen::VectorXd&);
template ErrorNorms error_norms(const FiniteElementSpace<3>&, const std::vector<Point<3>>&,
                                const ManufacturedSolution<3>&, const Eigen::VectorXd&,
                                const Eigen::VectorXd&);

}  // namespace smoothfem
