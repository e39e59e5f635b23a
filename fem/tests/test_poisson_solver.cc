#include "fem/poisson_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "fem/assembly.h"
#include "fem/condition_number.h"
#include "fem/error_norms.h"
#include "fem/tests/unit_square.h"

namespace smoothfem {
namespace {

struct Case {
  Cells cells;
  int degree;
};

std::string case_name(const testing::TestParamInfo<Case>& info) {
  const char* cells[] = {"triangles", "quadrilaterals", "mixed"};
  return std::string(cells[static_cast<int>(info.param.cells)]) + "_degree_" +
         std::to_string(info.param.degree);
}

class PoissonSolverTest : public testing::TestWithParam<Case> {
 protected:
  static PoissonOptions exact_options(int degree) {
    PoissonOptions options;
    options.degree = degree;
    options.cg_tolerance = 1e-14;
    return options;
  }
};

INSTANTIATE_TEST_SUITE_P(Elements, PoissonSolverTest,
                         testing::Values(Case{Cells::triangles, 1}, Case{Cells::triangles, 2},
                                         Case{Cells::quadrilaterals, 1},
                                         Case{Cells::quadrilaterals, 2}, Case{Cells::mixed, 1},
                                         Case{Cells::mixed, 2}),
                         case_name);

TEST_P(PoissonSolverTest, NumberOfDofsFollowsFromTheTopology) {
  const auto mesh = unit_square(5, GetParam().cells, 0.2);
  const auto space = make_finite_element_space(mesh, GetParam().degree, 8);
  const auto& topology = mesh.topology();
  std::size_t n_quadrilaterals = 0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    n_quadrilaterals += topology.cell_nodes(c).size() == 4;
  const std::size_t expected = GetParam().degree == 1
                                   ? mesh.n_nodes()
                                   : mesh.n_nodes() + topology.n_edges() + n_quadrilaterals;
  EXPECT_EQ(space->n_dofs, expected);
  const std::size_t on_boundary = topology.boundary_facets().size() * GetParam().degree;
  EXPECT_EQ(space->n_free, expected - on_boundary);
}

TEST_P(PoissonSolverTest, SolutionInTheSpaceIsFoundUpToRoundOff) {
  const auto mesh = unit_square(6, GetParam().cells, 0.25);
  for (const bool galerkin : {false, true}) {
    PoissonOptions options = exact_options(GetParam().degree);
    options.galerkin_load = galerkin;
    const std::string name = GetParam().degree == 1 ? "linear" : "quadratic";
    const auto record = PoissonSolver(mesh, options).solve(mesh, manufactured_solution(name));
    EXPECT_EQ(record.status, "ok");
    EXPECT_LT(record.e_max, 1e-11);
    EXPECT_LT(record.e_h1, 1e-10);
    EXPECT_LT(record.l2_error, 1e-11);
    EXPECT_LT(record.h1_error, 1e-10);
  }
}

TEST_P(PoissonSolverTest, TrueErrorsFallWithTheExpectedOrders) {
  const int degree = GetParam().degree;
  std::vector<double> l2, h1;
  for (const std::size_t n : {8UL, 16UL, 32UL}) {
    const auto mesh = unit_square(n, GetParam().cells, 0.15);
    PoissonOptions options = exact_options(degree);
    options.galerkin_load = true;
    const auto record = PoissonSolver(mesh, options).solve(mesh, manufactured_solution("sine"));
    l2.push_back(record.l2_error);
    h1.push_back(record.h1_error);
  }
  for (std::size_t i = 0; i + 1 < l2.size(); ++i) {
    EXPECT_NEAR(std::log2(l2[i] / l2[i + 1]), degree + 1, 0.3);
    EXPECT_NEAR(std::log2(h1[i] / h1[i + 1]), degree, 0.2);
  }
}

TEST_P(PoissonSolverTest, ConditionNumberAgreesWithDenseEigenvalues) {
  const auto mesh = unit_square(7, GetParam().cells, 0.3);
  const auto space = make_finite_element_space(mesh, GetParam().degree, 8);
  PoissonSystem system = make_system(*space);
  assemble(*space, mesh.coordinates(), manufactured_solution("sine"), Load::nodal, system);
  const Eigen::MatrixXd dense = system.matrix;
  EXPECT_LT((dense - dense.transpose()).norm(), 1e-13 * dense.norm());
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues();
  const auto condition = ConditionNumberSolver().compute(system.matrix);
  EXPECT_TRUE(condition.verified);
  EXPECT_NEAR(condition.lambda_min / eigenvalues.minCoeff(), 1.0, 1e-9);
  EXPECT_NEAR(condition.lambda_max / eigenvalues.maxCoeff(), 1.0, 1e-9);
}

TEST_P(PoissonSolverTest, DiscreteSolutionAgreesWithADenseSolve) {
  const auto mesh = unit_square(6, GetParam().cells, 0.3);
  const auto space = make_finite_element_space(mesh, GetParam().degree, 8);
  const auto& solution = manufactured_solution("gear");
  PoissonSystem system = make_system(*space);
  assemble(*space, mesh.coordinates(), solution, Load::nodal, system);
  const Eigen::VectorXd free = Eigen::MatrixXd(system.matrix).ldlt().solve(system.right_hand_side);
  double e_max = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < space->n_free; ++i) {
    const double error =
        std::abs(free[static_cast<Eigen::Index>(i)] - system.exact[space->free_dofs[i]]);
    e_max = std::max(e_max, error);
    sum += error;
  }
  const auto record = PoissonSolver(mesh, exact_options(GetParam().degree)).solve(mesh, solution);
  EXPECT_NEAR(record.e_max, e_max, 1e-9);
  EXPECT_NEAR(record.e_mean, sum / static_cast<double>(space->n_free), 1e-9);
  EXPECT_GT(record.e_max, 1e-3);  // the solution is not in the space
}

TEST_P(PoissonSolverTest, SolvingMovedMeshesAgainGivesTheSameBitsAsAFreshSolver) {
  const auto first = unit_square(6, GetParam().cells, 0.3);
  PlanarMesh second = first;
  for (const NodeIndex i : second.topology().free_nodes())
    second.coordinates()[i] = 0.9 * second.coordinates()[i] + Point<2>(0.05, 0.05);
  PoissonOptions options;
  options.degree = GetParam().degree;
  const auto& solution = manufactured_solution("sine");
  PoissonSolver used(first, options);
  used.solve(first, solution);
  PoissonSolver copy(used);
  const auto again = used.solve(second, solution);
  for (const auto& other :
       {PoissonSolver(second, options).solve(second, solution), copy.solve(second, solution)}) {
    EXPECT_EQ(again.e_max, other.e_max);
    EXPECT_EQ(again.e_h1, other.e_h1);
    EXPECT_EQ(again.l2_error, other.l2_error);
    EXPECT_EQ(again.condition_number, other.condition_number);
    EXPECT_EQ(again.cg_iterations, other.cg_iterations);
    EXPECT_EQ(again.jacobi_cg_iterations, other.jacobi_cg_iterations);
  }
}

TEST_P(PoissonSolverTest, NormsOfTheConstantOneAreThoseOfTheArea) {
  const auto mesh = unit_square(4, GetParam().cells, 0.3);
  const auto space = make_finite_element_space(mesh, GetParam().degree, 8);
  const auto n = static_cast<Eigen::Index>(space->n_dofs);
  const auto norms = error_norms(*space, mesh.coordinates(), manufactured_solution("linear"),
                                 Eigen::VectorXd::Constant(n, 1.0), Eigen::VectorXd::Zero(n));
  EXPECT_NEAR(norms.e_l2, 1.0, 1e-14);
  EXPECT_NEAR(norms.e_h1, 1.0, 1e-12);
  // u = 1 + 2x - 3y: integral of u^2 over the unit square is 13/12 + 1/4, of |grad u|^2 is 13.
  const double square = 4.0 / 12.0 + 9.0 / 12.0 + 0.25;
  EXPECT_NEAR(norms.l2_error, std::sqrt(square), 1e-13);
  EXPECT_NEAR(norms.h1_error, std::sqrt(square + 13.0), 1e-13);
}

TEST(PoissonSolver, SquareOfFourQuadrilateralsByHand) {
  // One free node in the middle of a 2 x 2 grid of squares: the bilinear stiffness is 8/3, so the
  // condition number is 1, and the solution follows from one equation.
  const auto mesh = unit_square(2, Cells::quadrilaterals, 0.0);
  PoissonOptions options;
  const auto record = PoissonSolver(mesh, options).solve(mesh, manufactured_solution("quadratic"));
  EXPECT_EQ(record.n_free, 1U);
  EXPECT_NEAR(record.lambda_max, 8.0 / 3.0, 1e-14);
  EXPECT_NEAR(record.condition_number, 1.0, 1e-14);
  EXPECT_LE(record.cg_iterations, 1U);
}

TEST(PoissonSolver, NodalErrorsAreThoseAtTheMeshNodes) {
  const auto mesh = unit_square(5, Cells::triangles, 0.2);
  PoissonOptions options;
  PoissonSolver solver(mesh, options);
  const auto record = solver.solve(mesh, manufactured_solution("sine"));
  const auto errors = solver.nodal_errors();
  ASSERT_EQ(errors.size(), mesh.n_nodes());
  EXPECT_EQ(*std::max_element(errors.begin(), errors.end()), record.e_max);
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    if (mesh.topology().on_boundary()[i]) {
      EXPECT_EQ(errors[i], 0.0);
    }
}

TEST(PoissonSolver, IterationLimitIsAStatusNotASilentCut) {
  const auto mesh = unit_square(8, Cells::triangles, 0.3);
  PoissonOptions options;
  options.max_cg_iterations_per_dof = 0.1;
  const auto record = PoissonSolver(mesh, options).solve(mesh, manufactured_solution("sine"));
  EXPECT_FALSE(record.cg_converged);
  EXPECT_EQ(record.status, "CG stopped at its limit of iterations");
}

TEST(PoissonSolver, RefusesPolygonsDegreesAndMeshesWithoutUnknowns) {
  const std::vector<Point<2>> corners{{0, 0}, {1, 0}, {1.3, 0.8}, {0.5, 1.4}, {-0.3, 0.8}};
  const PlanarMesh pentagon(
      std::make_shared<Topology>(2, 5, CompressedRows<NodeIndex>({0, 5}, {0, 1, 2, 3, 4})),
      corners);
  PoissonOptions options;
  EXPECT_THROW(PoissonSolver(pentagon, options), InputError);
  EXPECT_THROW(PoissonSolver(unit_square(1, Cells::quadrilaterals, 0.0), options), InputError);
  options.degree = 3;
  EXPECT_THROW(PoissonSolver(unit_square(3, Cells::triangles, 0.0), options), InputError);
}

}  // namespace
}  // namespace smoothfem
