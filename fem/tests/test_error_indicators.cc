// SPDX-License-Identifier: GPL-3.0-or-later
// Where the error of a solution is, by the residual, and its second derivatives, by the recovery.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/adaptivity/gradient_recovery.h"
#include "fem/adaptivity/poisson_problem.h"
#include "fem/adaptivity/residual_indicator.h"
#include "fem/assembly/assembly.h"
#include "fem/poisson_solver.h"
#include "fem/tests/unit_mesh.h"

namespace smoothfem {
namespace {

std::vector<Case> smooth_cases() {
  auto cases = all_cases();
  std::erase_if(cases, [](const Case& c) {
    return c.cells == Cells::pyramids || c.cells == Cells::prisms || c.cells == Cells::mixed_volume;
  });
  return cases;
}

template <int dim>
ManufacturedSolution<dim> without_load() {
  auto solution = manufactured_solution<dim>("linear");
  solution.load = [](const Point<dim>&) { return 0.0; };
  return solution;
}

/// Four squares with sides of 1/2 and the hat function of the node between them. Across x = 1/2,
/// for y below 1/2, its normal derivative goes from 4 y to -4 y: the facet's dofs have jumps of 0
/// and 4. So h_F |[du/dn]|^2 / 2 is 1/2 1/2 (0 + 16) / 2 1/2 = 1. Each cell has two such facets,
/// and a size of 1/4.
TEST(ResidualIndicator, OfAHatFunctionMatchesHandComputation) {
  const auto mesh = unit_square(2, Cells::quadrilaterals, 0.0);
  const auto space = make_finite_element_space<2>(&mesh, 1, {});
  Eigen::VectorXd u = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space->n_local));
  u[0] = 1.0;  // the only free dof
  const auto x = space->local_coordinates(mesh.coordinates());
  for (const double e : residual_indicators(*space, x, u, without_load<2>()))
    EXPECT_NEAR(e, std::sqrt(2.0 / 0.25), 1e-12);
}

/// Eight triangles, the hat function of the node between six of them, and a second formula.
TEST(ResidualIndicator, OfAHatFunctionOnTrianglesIsThatOfAllPairs) {
  const auto mesh = unit_square(2, Cells::triangles, 0.1);
  const auto space = make_finite_element_space<2>(&mesh, 1, {});
  Eigen::VectorXd u = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space->n_local));
  u[0] = 1.0;
  const auto indicators = residual_indicators(*space, space->local_coordinates(mesh.coordinates()),
                                              u, without_load<2>());
  // Gradients from the edges opposite to the node, facets by common nodes.
  const NodeIndex middle = mesh.topology().free_nodes()[0];
  const auto& t = mesh.topology();
  const auto cross = [](const Point<2>& a, const Point<2>& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  const auto x = [&](NodeIndex i) { return mesh.coordinates()[i]; };
  std::vector<Point<2>> gradients(t.n_cells(), Point<2>::Zero());
  std::vector<double> sizes(t.n_cells());
  for (CellIndex c = 0; c < t.n_cells(); ++c) {
    const auto n = t.cell_nodes(c);
    sizes[c] = 0.5 * cross(x(n[1]) - x(n[0]), x(n[2]) - x(n[0]));
    for (std::size_t k = 0; k < 3; ++k)
      if (n[k] == middle) {
        const Point<2> edge = x(n[(k + 2) % 3]) - x(n[(k + 1) % 3]);
        gradients[c] = Point<2>(-edge.y(), edge.x()) / (2.0 * sizes[c]);
      }
  }
  std::vector<double> squares(t.n_cells(), 0.0);
  for (CellIndex a = 0; a < t.n_cells(); ++a)
    for (CellIndex b = 0; b < t.n_cells(); ++b) {
      std::vector<NodeIndex> common;
      for (const NodeIndex i : t.cell_nodes(a))
        for (const NodeIndex j : t.cell_nodes(b))
          if (i == j) common.push_back(i);
      if (common.size() != 2) continue;
      const Point<2> edge = x(common[1]) - x(common[0]);
      const double jump = cross(edge, gradients[a] - gradients[b]);  // times the length
      squares[a] += 0.5 * jump * jump;
    }
  std::vector<double> expected;
  for (CellIndex c = 0; c < t.n_cells(); ++c) expected.push_back(std::sqrt(squares[c] / sizes[c]));
  ASSERT_EQ(indicators.size(), expected.size());
  for (CellIndex c = 0; c < t.n_cells(); ++c) EXPECT_NEAR(indicators[c], expected[c], 1e-12) << c;
}

/// u = x^2 on squares with sides h. In a column of cells the gradient of the interpolant is 2 x_m,
/// at its middle; the recovered one is 2 x, by means over two columns. The mean of the square of
/// 2 (x - x_m) is h^2 / 3. At the boundary the difference goes from 0 to h, with the same mean.
TEST(GradientRecovery, OfAParabolaMatchesHandComputation) {
  constexpr std::size_t n = 6;
  constexpr double h = 1.0 / n;
  const auto mesh = unit_square(n, Cells::quadrilaterals, 0.0);
  const auto space = make_finite_element_space<2>(&mesh, 1, {});
  const auto x = space->local_coordinates(mesh.coordinates());
  const auto solution = derived_solution<2>("x^2", {}, {});
  PoissonSystem system = make_system(*space);
  assemble(*space, x, solution, Load::none, system);
  const auto differences = GradientRecovery<2>(*space, x, system.exact, solution).differences();
  ASSERT_EQ(differences.size(), n * n);
  for (const double d : differences) EXPECT_NEAR(d, h / std::sqrt(3.0), 1e-12);
}

class ErrorIndicatorTest : public testing::TestWithParam<Case> {
 protected:
  template <int dim>
  static std::unique_ptr<ProblemSolver<dim>> solved(const Problem<dim>& problem,
                                                    const Mesh<dim>& mesh) {
    auto solver = problem.make_solver();
    solver->prepare(mesh, GetParam().degree);
    solver->solve(mesh.coordinates());
    return solver;
  }
};

/// Polynomials of the element's degree leave no residual, on cells of any shape.
TEST_P(ErrorIndicatorTest, ResidualIsZeroWhereTheSolutionIsExact) {
  GetParam().on_mesh(4, 3, 0.15, []<int dim>(const Mesh<dim>& mesh) {
    const std::string u = GetParam().degree == 1 ? "1 + 2*x - y" : "x*x + 3*x*y - 2*y*y + x";
    const auto problem = make_poisson_problem<dim>(derived_solution<dim>(u, {}, {}));
    for (const double e : solved<dim>(*problem, mesh)->residual_indicators()) EXPECT_LT(e, 1e-6);
    const std::string tensor = dim == 2 ? "2, 1 ; 1, 3" : "2, 1, 0 ; 1, 3, 0 ; 0, 0, 1";
    const auto in_a_medium = make_poisson_problem<dim>(derived_solution<dim>(u, tensor, {}));
    for (const double e : solved<dim>(*in_a_medium, mesh)->residual_indicators())
      EXPECT_LT(e, 1e-6);
  });
}

/// It falls at the rate of the error under refinement.
TEST_P(ErrorIndicatorTest, ResidualEstimatesTheSizeOfTheError) {
  if (GetParam().cells == Cells::mixed) GTEST_SKIP() << "cells of two sizes";
  with_dimension(dimension_of(GetParam().cells), []<int dim>() {
    const auto solution = manufactured_solution<dim>(dim == 2 ? "gear" : "volume");
    const auto ratio = [&](std::size_t n) {
      const auto mesh = unit_mesh<dim>(n, GetParam().cells, 0.0);
      const auto problem = make_poisson_problem<dim>(solution);
      double square = 0.0;
      for (const double e : solved<dim>(*problem, mesh)->residual_indicators())
        square += e * e / static_cast<double>(mesh.n_cells());
      PoissonSolver<dim> errors(&mesh, {.degree = GetParam().degree,
                                        .load = Load::quadrature,
                                        .condition_number = ConditionNumberMethod::none,
                                        .jacobi_cg = Recorded::never});
      return std::sqrt(square) / errors.solve(mesh.coordinates(), solution).h1_error;
    };
    const double coarse = ratio(dim == 2 ? 12 : 5), fine = ratio(dim == 2 ? 24 : 10);
    EXPECT_GT(fine, 1.0);
    EXPECT_LT(fine, 30.0);
    EXPECT_NEAR(coarse / fine, 1.0, 0.4);
  });
}

/// On a regular mesh the recovered gradient of a polynomial of degree 2 is exact inside.
TEST_P(ErrorIndicatorTest, HessiansAreThoseOfPolynomials) {
  if (GetParam().cells == Cells::mixed) GTEST_SKIP() << "averages are exact on regular meshes only";
  GetParam().on_mesh(6, 4, 0.0, []<int dim>(const Mesh<dim>& mesh) {
    const auto problem = make_poisson_problem<dim>(derived_solution<dim>("x*x + 3*x*y", {}, {}));
    const auto hessians = solved<dim>(*problem, mesh)->recovered_hessians();
    CellTensor<dim> expected = CellTensor<dim>::Zero();
    expected(0, 0) = 2.0;
    expected(0, 1) = expected(1, 0) = 3.0;
    std::size_t n_inside = 0;
    for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
      const auto nodes = mesh.topology().cell_nodes(c);
      if (std::any_of(nodes.begin(), nodes.end(),
                      [&](NodeIndex i) { return mesh.topology().on_boundary()[i]; }))
        continue;
      ++n_inside;
      EXPECT_LT((hessians[c] - expected).norm(), 1e-6) << c;
    }
    EXPECT_GT(n_inside, 0u);
  });
}

INSTANTIATE_TEST_SUITE_P(Elements, ErrorIndicatorTest, testing::ValuesIn(smooth_cases()),
                         [](const auto& info) { return name_of(info.param); });

}  // namespace
}  // namespace smoothfem
