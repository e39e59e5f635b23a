// SPDX-License-Identifier: GPL-3.0-or-later
// One mesh for several solutions: sums of energies and what follows from them.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/adaptivity/poisson_problem.h"
#include "fem/tests/gradient_of_differences.h"
#include "fem/tests/unit_mesh.h"
#include "smoothing/solution/error_indicators.h"

namespace smoothfem {
namespace {

template <int dim>
ManufacturedSolution<dim> solution_of(const std::string& u, const std::string& diffusivity = {}) {
  return derived_solution<dim>(u, diffusivity, {});
}

/// A solver after a solve, with the objects that it refers to.
template <int dim>
struct Solved {
  std::shared_ptr<const Problem<dim>> problem;
  std::unique_ptr<ProblemSolver<dim>> solver;

  ProblemSolver<dim>* operator->() const { return solver.get(); }
};

template <int dim>
Solved<dim> solved(std::shared_ptr<const Problem<dim>> problem, const Mesh<dim>& mesh,
                   int degree = 1) {
  auto solver = problem->make_solver();
  solver->prepare(mesh, degree);
  solver->solve(mesh.coordinates());
  return {std::move(problem), std::move(solver)};
}

template <int dim>
Solved<dim> solved(const std::vector<ManufacturedSolution<dim>>& solutions, const Mesh<dim>& mesh,
                   int degree = 1) {
  return solved(make_poisson_problem<dim>(solutions), mesh, degree);
}

class CombinedProblem : public testing::TestWithParam<Cells> {
 protected:
  /// Two solutions with different loads, boundary values, sizes and operators.
  template <int dim>
  static std::vector<ManufacturedSolution<dim>> two() {
    return {solution_of<dim>("exp(-3*x)*sin(2*y) + x*y"),
            solution_of<dim>("40*cos(3*y + x)", "1 + x*y")};
  }
  template <class Check>
  static void on_mesh(const Check& check) {
    with_dimension(dimension_of(GetParam()), [&]<int dim>() {
      check.template operator()<dim>(unit_mesh<dim>(dim == 2 ? 6 : 4, GetParam(), 0.15));
    });
  }
};

TEST_P(CombinedProblem, OfOneProblemEqualsThatProblem) {
  on_mesh([]<int dim>(const Mesh<dim>& mesh) {
    const auto solution = two<dim>()[0];
    const auto one = solved<dim>(make_poisson_problem<dim>(solution), mesh),
               list = solved<dim>(std::vector{solution}, mesh);
    EXPECT_EQ(list->solve(mesh.coordinates()), one->solve(mesh.coordinates()));
    EXPECT_EQ(list->energy_gradient(), one->energy_gradient());
    EXPECT_EQ(list->recovery_indicators(), one->recovery_indicators());
    EXPECT_EQ(list->recovery_tensors(), one->recovery_tensors());
    EXPECT_EQ(list->residual_indicators(), one->residual_indicators());
    EXPECT_EQ(list->recovered_hessians(), one->recovered_hessians());
    EXPECT_EQ(list->effort().n_solves, 1u);
  });
}

TEST_P(CombinedProblem, OfTwoEqualProblemsHasTwiceTheEnergyAndEqualDirections) {
  on_mesh([]<int dim>(const Mesh<dim>& mesh) {
    const auto solution = two<dim>()[0];
    const auto one = solved<dim>(std::vector{solution}, mesh),
               both = solved<dim>(std::vector{solution, solution}, mesh);
    EXPECT_EQ(both->solve(mesh.coordinates()), 2.0 * one->solve(mesh.coordinates()));
    EXPECT_EQ(both->effort().n_solves, 2u);
    const auto g = one->energy_gradient(), twice = both->energy_gradient();
    for (std::size_t i = 0; i < g.size(); ++i) EXPECT_EQ(twice[i], 2.0 * g[i]);
    const auto e = one->recovery_indicators(), root = both->recovery_indicators();
    const auto h = one->recovered_hessians(), absolute = both->recovered_hessians();
    for (std::size_t c = 0; c < e.size(); ++c) {
      EXPECT_NEAR(root[c], std::sqrt(2.0) * e[c], 1e-12);
      EXPECT_NEAR((absolute[c] * absolute[c] - 2.0 * h[c] * h[c]).norm(), 0.0,
                  1e-9 * (1.0 + h[c].squaredNorm()));
    }
  });
}

/// A solution that is a thousand times as large counts no more than the other one. A solution that
/// bends in the opposite direction cancels nothing.
TEST_P(CombinedProblem, CountsByRelativeErrors) {
  on_mesh([]<int dim>(const Mesh<dim>& mesh) {
    const auto one = solved<dim>(std::vector{solution_of<dim>("x^3 + y^2")}, mesh);
    const auto both = solved<dim>(
        std::vector{solution_of<dim>("x^3 + y^2"), solution_of<dim>("-1000*(x^3 + y^2)")}, mesh);
    const auto g = one->energy_gradient(), sum = both->energy_gradient();
    double scale = 0.0, along = 0.0, square = 0.0;
    for (std::size_t i = 0; i < g.size(); ++i) {
      scale += g[i].squaredNorm();
      along += g[i].dot(sum[i]);
      square += sum[i].squaredNorm();
    }
    EXPECT_NEAR(along / std::sqrt(scale * square), 1.0, 1e-9);
    // Each of the two has one half of the sum of squares.
    const double first = estimated_squared_error(mesh, *one.solver),
                 all = estimated_squared_error(mesh, *both.solver);
    EXPECT_NEAR(all / first, 1.0 + 1e6, 1e-3 * all / first);
    double bend = 0.0;
    for (const auto& h : both->recovered_hessians()) bend += h.norm();
    EXPECT_GT(bend, 0.0);
  });
}

TEST_P(CombinedProblem, SkipsSolutionsWithoutError) {
  on_mesh([]<int dim>(const Mesh<dim>& mesh) {
    const auto curved = two<dim>()[0];
    const auto one = solved<dim>(std::vector{curved}, mesh),
               both = solved<dim>(std::vector{solution_of<dim>("1 + 2*x - y"), curved}, mesh),
               none = solved<dim>(std::vector{solution_of<dim>("x"), solution_of<dim>("y")}, mesh);
    EXPECT_EQ(both->solve(mesh.coordinates()), one->solve(mesh.coordinates()));
    EXPECT_EQ(both->energy_gradient(), one->energy_gradient());
    EXPECT_TRUE(std::isfinite(none->solve(mesh.coordinates())));
  });
}

TEST_P(CombinedProblem, GradientAgreesWithDifferences) {
  on_mesh([]<int dim>(const Mesh<dim>& mesh) {
    for (const int degree : {1, 2}) {
      // Solutions in the space of degree 2 have loads that rules integrate exactly.
      const std::vector<ManufacturedSolution<dim>> simple{
          solution_of<dim>("x*y + y^2"), solution_of<dim>("40*(x^2 - x*y)", "1 + y")};
      const auto solver = solved<dim>(degree == 1 ? simple : two<dim>(), mesh, degree);
      SCOPED_TRACE(degree);
      expect_gradient_of_differences(*solver.solver, mesh);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Elements, CombinedProblem,
                         testing::Values(Cells::triangles, Cells::quadrilaterals, Cells::tetrahedra,
                                         Cells::hexahedra),
                         [](const auto& info) { return std::string(name_of(info.param)); });

}  // namespace
}  // namespace smoothfem
