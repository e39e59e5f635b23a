// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/assembly/error_norms.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fem/assembly/cell_integrals.h"

namespace smoothfem {

namespace {

/// Integrals over cells of the squares of the values and gradients of I_h u - u_h, u - u_h and u_h.
struct SquareSums {
  std::array<double, 6> sums{};

  template <class Gradient>
  void add(std::size_t first, double weight, double value, const Gradient& gradient) {
    sums[first] += weight * value * value;
    sums[first + 1] += weight * squared_length(gradient);
  }
  void add(const SquareSums& other) {
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += other.sums[k];
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

/// Functions of the norms, and their integrals over cells.
template <int dim>
struct Errors {
  const FiniteElementSpace<dim>& space;
  const std::vector<Point<dim>>& x;
  const ManufacturedSolution<dim>& solution;
  const Eigen::VectorXd &exact, &discrete;

  /// Returns the sums of a cell, by one of the element's rules.
  template <std::size_t n_dofs, std::size_t n_vertices>
  void add_cell(const ElementCells& group, std::size_t cell, const QuadratureTable& table,
                SquareSums& sums) const {
    const auto vertices = cell_vertices<dim, n_vertices>(group, cell, x);
    std::array<double, n_dofs> difference, approximation;
    for (std::size_t i = 0; i < n_dofs; ++i) {
      const std::uint32_t dof = group.dofs[cell * n_dofs + i];
      difference[i] = exact[dof] - discrete[dof];
      approximation[i] = discrete[dof];
    }
    const auto add = [&](std::size_t q, const auto& mapped, const ValueAndGradient<dim>& u) {
      const double* shape = &table.shape[q * n_dofs];
      const double* shape_gradient = &table.shape_gradient[dim * q * n_dofs];
      const FunctionAtPoint<dim> e_h(difference, shape, shape_gradient, mapped);
      const FunctionAtPoint<dim> u_h(approximation, shape, shape_gradient, mapped);
      sums.add(0, mapped.weight, e_h.value, e_h.gradient);
      sums.add(2, mapped.weight, u.value - u_h.value, vector_of(u.gradient) - u_h.gradient);
      sums.add(4, mapped.weight, u_h.value, u_h.gradient);
    };
    for_each_point(table, vertices, solution.value_and_gradient, add);
  }

  template <std::size_t n_dofs, std::size_t n_vertices>
  SquareSums of_cell(const ElementCells& group, std::size_t cell,
                     const QuadratureTable& table) const {
    SquareSums sums;
    add_cell<n_dofs, n_vertices>(group, cell, table, sums);
    return sums;
  }
};

/// True if a finer rule changes a cell's share of each sum little, relative to that share or to the
/// mean share of all cells. The sum over all cells then changes little, too. Errors of the size of
/// rounding are ignored.
bool is_near(const SquareSums& coarse, const SquareSums& fine, const SquareSums& mean,
             double tolerance) {
  constexpr double rounding = 1e-24;  // of the squares
  constexpr std::size_t n_errors = 4;
  for (std::size_t k = 0; k < n_errors; ++k) {
    const double of_u = mean.sums[n_errors + k % 2];
    if (!(std::abs(fine.sums[k] - coarse.sums[k]) <=
          tolerance * std::max(fine.sums[k], mean.sums[k]) + rounding * of_u))
      return false;
  }
  return true;
}

/// Calls visit(sums) for the cells of this rank whose rule is chosen, in their order. Collective.
template <int dim, class Visit>
void for_each_cell_by_chosen_rule(const Errors<dim>& errors, const Visit& visit,
                                  adaptive_quadrature::Use& points) {
  SquareSums mean;
  std::vector<SquareSums> of_cells;  // by the first rule
  for_each_group(
      errors.space, [&]<std::size_t n_dofs, std::size_t n_vertices>(const ElementCells& group) {
        if (group.element.n_rules() == 1) return;
        for (std::size_t cell = 0; cell < group.n_own; ++cell) {
          of_cells.push_back(
              errors.template of_cell<n_dofs, n_vertices>(group, cell, group.element.rule(0)));
          mean.add(of_cells.back());
        }
      });
  errors.space.ranks.sum(mean.sums);
  const auto n_cells = static_cast<double>(errors.space.ranks.sum(of_cells.size()));
  if (!(n_cells > 0.0)) return;
  for (double& sum : mean.sums) sum /= n_cells;
  auto next = of_cells.begin();
  for_each_group(
      errors.space, [&]<std::size_t n_dofs, std::size_t n_vertices>(const ElementCells& group) {
        if (group.element.n_rules() == 1) return;
        for (std::size_t cell = 0; cell < group.n_own; ++cell) {
          const auto sums_by = [&](const QuadratureTable& table) {
            return errors.template of_cell<n_dofs, n_vertices>(group, cell, table);
          };
          SquareSums sums = *next++;
          bool is_settled = is_near(sums_by(group.element.check), sums, mean,
                                    adaptive_quadrature::check_tolerance);
          std::size_t level = 0;
          while (!is_settled && level + 1 < group.element.n_rules()) {
            const SquareSums finer = sums_by(group.element.rule(++level));
            is_settled = is_near(sums, finer, mean,
                                 adaptive_quadrature::tolerance_at(level, group.element.n_rules()));
            sums = finer;
          }
          points.note(level, is_settled);
          visit(sums);
        }
      });
}

}  // namespace

template <int dim>
ErrorNorms error_norms(const FiniteElementSpace<dim>& space, const std::vector<Point<dim>>& x,
                       const ManufacturedSolution<dim>& solution, const Eigen::VectorXd& exact,
                       const Eigen::VectorXd& discrete) {
  const auto n_own = static_cast<Eigen::Index>(space.n_own);
  const auto at_dofs = (exact.head(n_own) - discrete.head(n_own)).cwiseAbs();
  const Errors<dim> errors{space, x, solution, exact, discrete};
  SquareSums squares;
  adaptive_quadrature::Use points;
  for_each_group(space, [&]<std::size_t n_dofs, std::size_t n_vertices>(const ElementCells& group) {
    if (group.element.n_rules() > 1) return;
    for (std::size_t cell = 0; cell < group.n_own; ++cell)
      errors.template add_cell<n_dofs, n_vertices>(group, cell, group.element.errors, squares);
  });
  if constexpr (dim == 3)
    for_each_cell_by_chosen_rule(
        errors, [&](const SquareSums& sums) { squares.add(sums); }, points);
  const auto& of_cells = squares.sums;
  std::array sums{at_dofs.sum(), of_cells[0], of_cells[1], of_cells[2], of_cells[3]};
  space.ranks.sum(sums);
  return {.e_max = space.ranks.max(n_own > 0 ? at_dofs.maxCoeff() : 0.0),
          .e_mean = sums[0] / static_cast<double>(space.n_free),
          .e_l2 = std::sqrt(sums[1]),
          .e_h1 = std::sqrt(sums[1] + sums[2]),
          .l2_error = std::sqrt(sums[3]),
          .h1_error = std::sqrt(sums[3] + sums[4]),
          .points = points};
}

template <int dim>
std::vector<ErrorOnCell> cell_errors(const FiniteElementSpace<dim>& space,
                                     const std::vector<Point<dim>>& x,
                                     const ManufacturedSolution<dim>& solution,
                                     const Eigen::VectorXd& exact,
                                     const Eigen::VectorXd& discrete) {
  const Errors<dim> errors{space, x, solution, exact, discrete};
  const auto error_of = [](const SquareSums& s) {
    return ErrorOnCell{.l2 = std::sqrt(s.sums[2]), .h1 = std::sqrt(s.sums[2] + s.sums[3])};
  };
  std::vector<ErrorOnCell> chosen;
  if constexpr (dim == 3) {
    adaptive_quadrature::Use ignored;
    for_each_cell_by_chosen_rule(
        errors, [&](const SquareSums& sums) { chosen.push_back(error_of(sums)); }, ignored);
  }
  std::vector<ErrorOnCell> of_cells;
  auto next = chosen.begin();
  for_each_group(space, [&]<std::size_t n_dofs, std::size_t n_vertices>(const ElementCells& group) {
    for (std::size_t cell = 0; cell < group.n_own; ++cell)
      of_cells.push_back(group.element.n_rules() > 1
                             ? *next++
                             : error_of(errors.template of_cell<n_dofs, n_vertices>(
                                   group, cell, group.element.errors)));
  });
  return of_cells;
}

template ErrorNorms error_norms(const FiniteElementSpace<2>&, const std::vector<Point<2>>&,
                                const ManufacturedSolution<2>&, const Eigen::VectorXd&,
                                const Eigen::VectorXd&);
template ErrorNorms error_norms(const FiniteElementSpace<3>&, const std::vector<Point<3>>&,
                                const ManufacturedSolution<3>&, const Eigen::VectorXd&,
                                const Eigen::VectorXd&);
template std::vector<ErrorOnCell> cell_errors(const FiniteElementSpace<2>&,
                                              const std::vector<Point<2>>&,
                                              const ManufacturedSolution<2>&,
                                              const Eigen::VectorXd&, const Eigen::VectorXd&);
template std::vector<ErrorOnCell> cell_errors(const FiniteElementSpace<3>&,
                                              const std::vector<Point<3>>&,
                                              const ManufacturedSolution<3>&,
                                              const Eigen::VectorXd&, const Eigen::VectorXd&);

}  // namespace smoothfem
