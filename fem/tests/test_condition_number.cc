// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear_algebra/condition_number.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "fem/assembly/assembly.h"
#include "fem/poisson_solver.h"
#include "fem/tests/random_vector.h"
#include "fem/tests/unit_mesh.h"

namespace smoothfem {
namespace {

/// The system of a unit mesh, also in Trilinos' form with multigrid set up.
template <int dim>
struct StiffnessProblem {
  std::shared_ptr<const FiniteElementSpace<dim>> space;
  PoissonSystem system;
  TrilinosMatrix trilinos;

  StiffnessProblem(const Mesh<dim>& mesh, int degree)
      : space(make_finite_element_space(&mesh, degree, TensorPoints{})),
        system(make_system(*space)),
        trilinos(*space) {
    assemble(*space, mesh.copied_coordinates(),
             manufactured_solution<dim>(dim == 2 ? "gear" : "volume"), Load::nodal, system);
    trilinos.set_values(system.matrix);
    trilinos.set_up_multigrid();
  }
};

double residual_of(const SparseMatrix& matrix, const Eigen::VectorXd& v, double eigenvalue) {
  return (matrix * v - eigenvalue * v).norm() / (eigenvalue * v.norm());
}

class ConditionNumberTest : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Elements, ConditionNumberTest, testing::ValuesIn(all_cases()),
                         [](const auto& info) { return name_of(info.param); });

TEST_P(ConditionNumberTest, AllMethodsAgreeWithDenseEigenvalues) {
  GetParam().on_mesh(6, GetParam().degree == 1 ? 4 : 3, 0.3, [&]<int dim>(const Mesh<dim>& mesh) {
    const StiffnessProblem<dim> problem(mesh, GetParam().degree);
    const SparseMatrix& matrix = problem.system.matrix;
    const Eigen::MatrixXd dense = matrix;
    EXPECT_LT((dense - dense.transpose()).norm(), 1e-13 * dense.norm());
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues();
    const auto expect_agreement = [&](const ConditionNumber& condition) {
      EXPECT_LE(condition.residual(), verified_residual) << condition.method;
      EXPECT_NEAR(condition.lambda_min / eigenvalues.minCoeff(), 1.0, 1e-9) << condition.method;
      EXPECT_NEAR(condition.lambda_max / eigenvalues.maxCoeff(), 1.0, 1e-9) << condition.method;
      EXPECT_EQ(condition.value(), condition.lambda_max / condition.lambda_min);
    };
    expect_agreement(dense_condition_number(matrix, problem.space->column_numbers,
                                            problem.space->n_free, problem.space->ranks));
    expect_agreement(CholeskyConditionNumber().compute(matrix));
    IterativeConditionNumber iterative;
    const auto condition = iterative.compute(problem.trilinos);
    expect_agreement(condition);
    const auto both = iterative.eigenvectors();
    ASSERT_EQ(both.size(), 2 * problem.space->n_free);
    const Eigen::Map<const Eigen::VectorXd> vectors(both.data(), 2 * matrix.rows());
    EXPECT_NEAR(residual_of(matrix, vectors.head(matrix.rows()), condition.lambda_min),
                condition.lambda_min_residual, 1e-9);
    EXPECT_NEAR(residual_of(matrix, vectors.tail(matrix.rows()), condition.lambda_max),
                condition.lambda_max_residual, 1e-9);
  });
}

TEST_P(ConditionNumberTest, LanczosNumbersOfCgComeCloseFromInside) {
  GetParam().on_mesh(20, 7, 0.2, [&]<int dim>(const Mesh<dim>& mesh) {
    const StiffnessProblem<dim> problem(mesh, GetParam().degree);
    const auto verified = IterativeConditionNumber().compute(problem.trilinos);
    ASSERT_LE(verified.residual(), verified_residual);
    Eigen::VectorXd x;
    const auto cg = conjugate_gradients(SlicedMatrix(problem.system.matrix),
                                        problem.system.right_hand_side, x, {.tolerance = 1e-8});
    const auto lanczos = lanczos_condition_number(cg.lanczos);
    EXPECT_NEAR(lanczos.value() / verified.value(), 1.0, 1e-3);
    EXPECT_LE(lanczos.value(), verified.value() * (1.0 + 1e-9));
    EXPECT_GE(lanczos.lambda_min, verified.lambda_min * (1.0 - 1e-9));
    EXPECT_LE(lanczos.lambda_max, verified.lambda_max * (1.0 + 1e-9));
  });
}

TEST_P(ConditionNumberTest, AStartVectorChangesNothingBeyondTheTolerance) {
  GetParam().on_mesh(7, 4, 0.2, [&]<int dim>(const Mesh<dim>& mesh) {
    const StiffnessProblem<dim> problem(mesh, GetParam().degree);
    IterativeConditionNumber cold;
    const auto expected = cold.compute(problem.trilinos);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> dense{
        Eigen::MatrixXd(problem.system.matrix)};
    const Eigen::Index n = problem.system.matrix.rows();
    const auto expect_same = [&](const Eigen::VectorXd& smallest, const Eigen::VectorXd& largest) {
      std::vector<double> start(smallest.begin(), smallest.end());
      start.insert(start.end(), largest.begin(), largest.end());
      IterativeConditionNumber warm;
      warm.set_eigenvectors(start);
      const auto condition = warm.compute(problem.trilinos);
      EXPECT_LE(condition.residual(), verified_residual);
      EXPECT_NEAR(condition.lambda_min / expected.lambda_min, 1.0, 1e-9);
      EXPECT_NEAR(condition.lambda_max / expected.lambda_max, 1.0, 1e-9);
    };
    expect_same(dense.eigenvectors().col(0), dense.eigenvectors().col(n - 1));
    expect_same(random_vector(n, 1), random_vector(n, 2));
    // Exact eigenvectors of other eigenvalues, as if another cell had been the worst before.
    expect_same(dense.eigenvectors().col(1), dense.eigenvectors().col(n - 2));
  });
}

TEST(ConditionNumber, MeshesOfFewDofsAreDense) {
  const auto mesh = unit_cube(4, Cells::tetrahedra, 0.2);
  PoissonSolver<3> solver(&mesh, PoissonOptions{});
  const auto record = solver.solve(mesh.coordinates(), manufactured_solution<3>("sine"));
  EXPECT_LE(record.n_free, dense_limit);
  EXPECT_EQ(record.condition_method, "dense");
  EXPECT_LE(record.condition_residual, verified_residual);
  EXPECT_TRUE(solver.eigenvectors().empty());
}

TEST(ConditionNumber, RecordsNameTheirMethod) {
  const auto mesh = unit_cube(7, Cells::hexahedra, 0.2);
  const auto solve = [&](ConditionNumberMethod method, bool is_result) {
    PoissonOptions options;
    options.condition_number = method;
    return PoissonSolver<3>(&mesh, options)
        .solve(mesh.coordinates(), manufactured_solution<3>("volume"), is_result);
  };
  const auto none = solve(ConditionNumberMethod::none, true);
  const auto lanczos = solve(ConditionNumberMethod::lanczos, false);
  const auto result = solve(ConditionNumberMethod::lanczos, true);
  const auto verified = solve(ConditionNumberMethod::verified, false);
  EXPECT_EQ(none.condition_method, "none");
  EXPECT_EQ(none.condition_number, 0.0);
  EXPECT_EQ(lanczos.condition_method, "cg-lanczos");
  EXPECT_EQ(result.condition_method, "krylov-schur+lobpcg");
  EXPECT_EQ(verified.condition_method, "krylov-schur+lobpcg");
  EXPECT_EQ(verified.status, "ok");
  EXPECT_EQ(verified.condition_number, result.condition_number);
  EXPECT_NEAR(lanczos.condition_number / verified.condition_number, 1.0, 1e-3);
}

TEST(ConditionNumber, EigenvectorsOfAnotherSizeAreIgnored) {
  const auto mesh = unit_cube(7, Cells::hexahedra, 0.2);
  const auto& solution = manufactured_solution<3>("sine");
  PoissonSolver<3> solver(&mesh, PoissonOptions{});
  const auto first = solver.solve(mesh.coordinates(), solution);
  const auto vectors = solver.eigenvectors();
  ASSERT_EQ(vectors.size(), 2 * first.n_free);
  solver.set_eigenvectors(std::vector<double>(vectors.size() - 2, 1.0));
  EXPECT_TRUE(solver.eigenvectors().empty());
  EXPECT_EQ(solver.solve(mesh.coordinates(), solution).condition_number, first.condition_number);
  solver.set_eigenvectors(vectors);
  EXPECT_EQ(solver.eigenvectors(), vectors);
}

TEST(ConditionNumber, UsesTheBetterValueForUnverifiedPairs) {
  const ConditionNumber lanczos{1.1, 90.0, 1e-3, 1e-4, "cg-lanczos"};
  const ConditionNumber good{1.0, 100.0, 1e-7, 1e-7, "krylov-schur+lobpcg"};
  EXPECT_EQ(better_of(good, lanczos).value(), 100.0);
  EXPECT_EQ(better_of(good, lanczos).method, good.method);
  // Nothing known: all from the other one.
  const auto other = better_of(ConditionNumber{.method = "lanczos+cholesky"}, lanczos);
  EXPECT_EQ(other.value(), lanczos.value());
  EXPECT_EQ(other.residual(), lanczos.residual());
  // Both lie inside the spectrum, so that the extreme one is better.
  const ConditionNumber inside{1.2, 95.0, 1e-2, 1e-2, "krylov-schur+lobpcg"};
  const auto mixed = better_of(inside, lanczos);
  EXPECT_EQ(mixed.lambda_min, lanczos.lambda_min);
  EXPECT_EQ(mixed.lambda_min_residual, lanczos.lambda_min_residual);
  EXPECT_EQ(mixed.lambda_max, inside.lambda_max);
  EXPECT_EQ(mixed.lambda_max_residual, inside.lambda_max_residual);
  // A value that is not finite is unknown.
  const ConditionNumber broken{std::nan(""), std::nan(""), std::nan(""), std::nan(""), "broken"};
  EXPECT_EQ(better_of(broken, lanczos).value(), lanczos.value());
}

TEST(ConditionNumber, OfAMatrixThatIsNotPositiveDefiniteIsNotVerified) {
  SparseMatrix matrix(2, 2);
  matrix.insert(0, 0) = 1.0;
  matrix.insert(1, 1) = -1.0;
  matrix.makeCompressed();
  const auto condition = CholeskyConditionNumber().compute(matrix);
  EXPECT_FALSE(condition.residual() <= verified_residual);
  EXPECT_EQ(condition.lambda_max, 0.0);
}

}  // namespace
}  // namespace smoothfem
