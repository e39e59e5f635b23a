// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/poisson_solver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <filesystem>
#include <set>

#include "fem/assembly/best_approximation.h"
#include "fem/assembly/error_norms.h"
#include "fem/linear_algebra/conjugate_gradients.h"
#include "fem/linear_algebra/trilinos_matrix.h"
#include "fem/tests/random_vector.h"
#include "fem/tests/unit_mesh.h"

namespace smoothfem {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class PoissonSolverTest : public testing::TestWithParam<Case> {
 protected:
  static PoissonOptions exact_options() {
    PoissonOptions options;
    options.degree = GetParam().degree;
    options.cg_tolerance = 1e-14;
    options.condition_number = ConditionNumberMethod::none;
    options.jacobi_cg = Recorded::never;
    return options;
  }
};

INSTANTIATE_TEST_SUITE_P(Elements, PoissonSolverTest, testing::ValuesIn(all_cases()),
                         [](const auto& info) { return name_of(info.param); });

/// Number of dofs on the boundary. Degree 2: counted from its facets by their nodes, edges and, for
/// quadrilaterals, insides. Degree 1: the nodes alone.
std::size_t n_boundary_dofs(const Topology& topology, int degree) {
  std::set<NodeIndex> nodes;
  std::set<std::pair<NodeIndex, NodeIndex>> edges;
  std::size_t n_quadrilaterals = 0;
  for (std::size_t f = 0; f < topology.boundary_facets().size(); ++f) {
    const auto facet = topology.boundary_facets()[f];
    for (std::size_t k = 0; k < facet.size(); ++k) {
      nodes.insert(facet[k]);
      edges.insert(std::minmax(facet[k], facet[(k + 1) % facet.size()]));
    }
    n_quadrilaterals += facet.size() == 4;
  }
  return degree == 1 ? nodes.size() : nodes.size() + edges.size() + n_quadrilaterals;
}

/// Number of dofs. Degree 1: V. Degree 2: V + E, and for tensor cells their insides and
/// quadrilateral faces.
std::size_t n_lagrange_dofs(const Topology& topology, int degree) {
  if (degree == 1) return topology.n_nodes();
  std::size_t n_tensor_cells = 0;
  for (CellIndex c = 0; c < topology.n_cells(); ++c)
    n_tensor_cells += topology.cell_type(c) == ElementType::quadrilateral ||
                      topology.cell_type(c) == ElementType::hexahedron;
  const bool hexahedra = topology.cell_type(0) == ElementType::hexahedron;
  return topology.n_nodes() + topology.n_edges() + n_tensor_cells +
         (hexahedra ? topology.n_facets() : 0);
}

TEST_P(PoissonSolverTest, NumberOfDofsFollowsFromTheTopology) {
  GetParam().on_mesh(5, 4, 0.2, [&]<int dim>(const Mesh<dim>& mesh) {
    const int degree = GetParam().degree;
    const auto space = make_finite_element_space(&mesh, degree, TensorPoints{});
    const std::size_t expected = n_lagrange_dofs(mesh.topology(), degree);
    const std::size_t on_boundary = n_boundary_dofs(mesh.topology(), degree);
    EXPECT_EQ(space->n_dofs, expected);
    EXPECT_EQ(space->n_local, expected);
    EXPECT_EQ(space->n_free, expected - on_boundary);
    EXPECT_EQ(space->n_own_boundary, on_boundary);
  });
}

TEST_P(PoissonSolverTest, SolutionInTheSpaceIsFoundUpToRoundOff) {
  const auto check = [&]<int dim>(const Mesh<dim>& mesh) {
    for (const bool galerkin : {false, true}) {
      PoissonOptions options = exact_options();
      options.load = galerkin ? Load::quadrature : Load::nodal;
      options.best_approximation = Recorded::always;
      const std::string name = GetParam().degree == 1 ? "linear" : "quadratic";
      const auto record = PoissonSolver<dim>(&mesh, options)
                              .solve(mesh.coordinates(), manufactured_solution<dim>(name));
      EXPECT_EQ(record.status, "ok");
      EXPECT_LT(record.e_max, 1e-11);
      EXPECT_LT(record.e_h1, 1e-10);
      EXPECT_LT(record.l2_error, 1e-11);
      EXPECT_LT(record.h1_error, 1e-10);
      EXPECT_LT(record.l2_best, 1e-9);
      EXPECT_LT(record.h1_best, 1e-9);
    }
  };
  GetParam().on_mesh(6, 5, 0.0, check);
  GetParam().on_mesh(6, 5, 0.25, check);
}

TEST_P(PoissonSolverTest, NoFunctionOfTheSpaceIsCloserThanTheBestApproximation) {
  GetParam().on_mesh(5, 4, 0.25, [&]<int dim>(const Mesh<dim>& mesh) {
    const auto& u = manufactured_solution<dim>("sine");
    auto options = exact_options();
    options.best_approximation = Recorded::always;
    const auto record = PoissonSolver<dim>(&mesh, options).solve(mesh.coordinates(), u);
    EXPECT_EQ(record.status, "ok");
    EXPECT_LT(record.l2_best, record.l2_error);
    EXPECT_LE(record.h1_best, record.h1_error);
    EXPECT_GT(record.h1_best, 0.5 * record.h1_error);

    const auto space = make_finite_element_space(&mesh, GetParam().degree, TensorPoints{});
    const auto x = mesh.copied_coordinates();
    auto system = make_system(*space);
    const auto n = static_cast<Eigen::Index>(space->n_free);
    for (const Norm norm : {Norm::l2, Norm::h1}) {
      const bool in_l2 = norm == Norm::l2;
      assemble_projection(*space, x, u, norm, system);
      Eigen::VectorXd best = system.exact;
      best.head(n) = Eigen::MatrixXd(system.matrix).llt().solve(system.right_hand_side);
      const auto of_best = error_norms(*space, x, u, system.exact, best);
      const double least = in_l2 ? of_best.l2_error : of_best.h1_error;
      EXPECT_NEAR(in_l2 ? record.l2_best : record.h1_best, least, 1e-9 * least);
      // The error of the best approximation is orthogonal to the space: Pythagoras.
      Eigen::VectorXd other = best;
      other.head(n) += 0.1 * least * random_vector(n, 1);
      const auto of_other = error_norms(*space, x, u, best, other);
      const double distance = in_l2 ? of_other.e_l2 : of_other.e_h1;
      const double error = in_l2 ? of_other.l2_error : of_other.h1_error;
      EXPECT_NEAR(error, std::hypot(least, distance), 1e-4 * error);
      EXPECT_GT(distance, 0.001 * least);
    }
  });
}

TEST_P(PoissonSolverTest, JacobiConditionNumberIsThatOfTheScaledMatrix) {
  GetParam().on_mesh(4, 3, 0.3, [&]<int dim>(const Mesh<dim>& mesh) {
    const auto& u = manufactured_solution<dim>("sine");
    auto options = exact_options();
    options.jacobi_cg = Recorded::always;
    options.cg_tolerance = 1e-8;
    const auto record = PoissonSolver<dim>(&mesh, options).solve(mesh.coordinates(), u);
    const auto space = make_finite_element_space(&mesh, GetParam().degree, TensorPoints{});
    auto system = make_system(*space);
    assemble(*space, mesh.copied_coordinates(), u, Load::quadrature, system);
    const Eigen::MatrixXd a(system.matrix);
    const Eigen::VectorXd scale = a.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * a *
                                                               scale.asDiagonal());
    const double expected = eigen.eigenvalues()[a.rows() - 1] / eigen.eigenvalues()[0];
    EXPECT_LE(record.jacobi_condition_number, (1.0 + 1e-9) * expected);
    EXPECT_GE(record.jacobi_condition_number, 0.99 * expected);
  });
}

TEST_P(PoissonSolverTest, TrueErrorsFallWithTheExpectedOrders) {
  const int degree = GetParam().degree;
  std::vector<double> l2, h1;
  for (const std::size_t refinement : {1UL, 2UL, 4UL})
    GetParam().on_mesh(8 * refinement, 5 * refinement, 0.15, [&]<int dim>(const Mesh<dim>& mesh) {
      PoissonOptions options = exact_options();
      options.load = Load::quadrature;
      const auto record = PoissonSolver<dim>(&mesh, options)
                              .solve(mesh.coordinates(), manufactured_solution<dim>("sine"));
      l2.push_back(record.l2_error);
      h1.push_back(record.h1_error);
    });
  // In the coarsest mixed volume mesh a fifth of the layers are tetrahedra. In the next one their
  // fraction is twice as large, in the last one hardly larger.
  const std::size_t first = GetParam().cells == Cells::mixed_volume ? 1 : 0;
  for (std::size_t i = first; i + 1 < l2.size(); ++i) {
    EXPECT_NEAR(std::log2(l2[i] / l2[i + 1]), degree + 1, 0.3);
    EXPECT_NEAR(std::log2(h1[i] / h1[i + 1]), degree, 0.2);
  }
}

TEST_P(PoissonSolverTest, DiscreteSolutionAgreesWithADenseSolve) {
  GetParam().on_mesh(6, 4, 0.3, [&]<int dim>(const Mesh<dim>& mesh) {
    const auto space = make_finite_element_space(&mesh, GetParam().degree, TensorPoints{});
    const auto& solution = manufactured_solution<dim>(dim == 2 ? "gear" : "volume");
    PoissonSystem system = make_system(*space);
    assemble(*space, mesh.copied_coordinates(), solution, Load::quadrature, system);
    const Eigen::VectorXd free =
        Eigen::MatrixXd(system.matrix).ldlt().solve(system.right_hand_side);
    const Eigen::VectorXd errors = (free - system.exact.head(free.size())).cwiseAbs();
    const auto record =
        PoissonSolver<dim>(&mesh, exact_options()).solve(mesh.coordinates(), solution);
    EXPECT_NEAR(record.e_max, errors.maxCoeff(), 1e-9);
    EXPECT_NEAR(record.e_mean, errors.mean(), 1e-9);
    EXPECT_GT(record.e_max, 1e-3);  // the solution is not in the space
  });
}

TEST_P(PoissonSolverTest, PreconditionersLeadToTheSameSolutionInFewerIterations) {
  GetParam().on_mesh(20, 16, 0.15, [&]<int dim>(const Mesh<dim>& mesh) {
    const auto space = make_finite_element_space(&mesh, GetParam().degree, TensorPoints{});
    PoissonSystem system = make_system(*space);
    assemble(*space, mesh.copied_coordinates(), manufactured_solution<dim>("sine"),
             Load::quadrature, system);
    const SlicedMatrix sliced(system.matrix);
    TrilinosMatrix trilinos(*space);
    trilinos.set_values(system.matrix);
    trilinos.set_up_multigrid();
    const auto multigrid = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
      trilinos.apply_multigrid(r, z);
    };
    Eigen::VectorXd plain, other;
    const ConjugateGradientsOptions options{.tolerance = 1e-12};
    const auto cg = conjugate_gradients(sliced, system.right_hand_side, plain, options);
    const auto expect_same = [&](const Preconditioner& preconditioner, std::size_t iterations) {
      const auto result =
          conjugate_gradients(sliced, system.right_hand_side, other, options, preconditioner);
      EXPECT_EQ(result.end, ConjugateGradientsEnd::converged);
      EXPECT_LE(result.iterations, iterations);
      EXPECT_LT((other - plain).norm(), 1e-9 * plain.norm());
    };
    // The diagonal hardly varies here, so that Jacobi gains nothing.
    expect_same(jacobi_preconditioner(sliced), cg.iterations + cg.iterations / 5);
    expect_same(multigrid, cg.iterations / 2);

    PoissonOptions recorded = exact_options();
    recorded.cg_tolerance = 1e-8;
    recorded.jacobi_cg = recorded.multigrid_cg = Recorded::always;
    const auto record = PoissonSolver<dim>(&mesh, recorded)
                            .solve(mesh.coordinates(), manufactured_solution<dim>("sine"));
    EXPECT_GT(record.amg_cg_iterations, 0U);
    EXPECT_LE(record.amg_cg_iterations, record.cg_iterations / 2);
    EXPECT_LE(record.jacobi_cg_iterations, record.cg_iterations + record.cg_iterations / 5);
  });
}

TEST_P(PoissonSolverTest, ReusedSolverIsBitwiseIdenticalToANewOne) {
  GetParam().on_mesh(6, 5, 0.3, [&]<int dim>(const Mesh<dim>& first) {
    Mesh<dim> second = first;
    for (const NodeIndex i : second.topology().free_nodes())
      second.coordinates()[i] = 0.9 * second.coordinates()[i] + Point<dim>::Constant(0.05);
    PoissonOptions options;
    options.degree = GetParam().degree;
    const auto& solution = manufactured_solution<dim>("sine");
    PoissonSolver<dim> used(&first, options);
    used.solve(first.coordinates(), solution);
    used.set_eigenvectors({});  // the next solves start from these
    PoissonSolver<dim> copy(used), fresh(&second, options);
    const auto again = used.solve(second.coordinates(), solution);
    for (const auto& other : {fresh.solve(second.coordinates(), solution),
                              copy.solve(second.coordinates(), solution)}) {
      EXPECT_EQ(again.e_max, other.e_max);
      EXPECT_EQ(again.e_h1, other.e_h1);
      EXPECT_EQ(again.l2_error, other.l2_error);
      EXPECT_EQ(again.condition_number, other.condition_number);
      EXPECT_EQ(again.cg_iterations, other.cg_iterations);
      EXPECT_EQ(again.jacobi_cg_iterations, other.jacobi_cg_iterations);
    }
    EXPECT_EQ(used.nodal_errors(), fresh.nodal_errors());
  });
}

TEST_P(PoissonSolverTest, NormsOfTheConstantOneAreThoseOfTheArea) {
  GetParam().on_mesh(4, 3, 0.3, [&]<int dim>(const Mesh<dim>& mesh) {
    const auto space = make_finite_element_space(&mesh, GetParam().degree, TensorPoints{});
    const auto n = static_cast<Eigen::Index>(space->n_dofs);
    const auto norms =
        error_norms(*space, mesh.copied_coordinates(), manufactured_solution<dim>("linear"),
                    Eigen::VectorXd::Constant(n, 1.0), Eigen::VectorXd::Zero(n));
    EXPECT_NEAR(norms.e_l2, 1.0, 1e-14);
    EXPECT_NEAR(norms.e_h1, 1.0, 1e-12);
    // u = 1 + 2x - 3y (+ z/2): over the unit square (cube) its mean is 1/2 (3/4). Its variance is a
    // twelfth of |grad u|^2, which is 13 (13.25).
    const double mean = dim == 2 ? 0.5 : 0.75, gradient = dim == 2 ? 13.0 : 13.25;
    const double square = mean * mean + gradient / 12.0;
    EXPECT_NEAR(norms.l2_error, std::sqrt(square), 1e-13);
    EXPECT_NEAR(norms.h1_error, std::sqrt(square + gradient), 1e-13);
  });
}

TEST_P(PoissonSolverTest, NodalErrorsAreThoseAtTheMeshNodes) {
  GetParam().on_mesh(5, 4, 0.2, [&]<int dim>(const Mesh<dim>& mesh) {
    PoissonOptions options = exact_options();
    PoissonSolver<dim> solver(&mesh, options);
    const auto record = solver.solve(mesh.coordinates(), manufactured_solution<dim>("sine"));
    const auto errors = solver.nodal_errors();
    ASSERT_EQ(errors.size(), mesh.n_nodes());
    const double largest = *std::max_element(errors.begin(), errors.end());
    if (GetParam().degree == 1)
      EXPECT_EQ(largest, record.e_max);
    else
      EXPECT_LE(largest, record.e_max);
    EXPECT_GT(largest, 0.0);
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      if (mesh.topology().on_boundary()[i]) {
        EXPECT_EQ(errors[i], 0.0);
      }
  });
}

TEST_P(PoissonSolverTest, TheDiscreteSolutionHasTheErrorsOfTheRecord) {
  GetParam().on_mesh(3, 3, 0.2, [&]<int dim>(const Mesh<dim>& mesh) {
    PoissonSolver<dim> solver(&mesh, exact_options());
    const auto& solution = manufactured_solution<dim>("sine");
    const auto record = solver.solve(mesh.coordinates(), solution);
    const auto found = solver.discrete_solution(mesh, solution);
    const auto errors = solver.nodal_errors();
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      EXPECT_EQ(std::abs(solution.value(mesh.coordinates()[i]) - found.node_values[i]), errors[i]);
    EXPECT_EQ(found.dof_values.size(), record.n_dofs);
    ASSERT_EQ(found.cell_errors.size(), mesh.n_cells());
    double square = 0.0;
    for (const ErrorOnCell& error : found.cell_errors) square += error.h1 * error.h1;
    EXPECT_NEAR(std::sqrt(square) / record.h1_error, 1.0, 1e-12);
  });
}

TEST_P(PoissonSolverTest, LimitsAreReportedInTheStatus) {
  GetParam().on_mesh(8, 6, 0.2, [&]<int dim>(const Mesh<dim>& mesh) {
    const auto solve = [&](const PoissonOptions& options) {
      return PoissonSolver<dim>(&mesh, options)
          .solve(mesh.coordinates(), manufactured_solution<dim>(dim == 2 ? "gear" : "volume"));
    };
    PoissonOptions few = exact_options();
    few.max_cg_iterations_per_dof = 0.05;
    const auto cut = solve(few);
    EXPECT_FALSE(cut.cg_converged);
    EXPECT_EQ(cut.status, "CG stopped at its limit of iterations");
    PoissonOptions short_time = exact_options();
    short_time.max_cg_seconds = 0.0;
    const auto stopped = solve(short_time);
    EXPECT_FALSE(stopped.cg_converged);
    EXPECT_EQ(stopped.cg_iterations, 1U);
    EXPECT_EQ(stopped.status, "CG stopped at its limit of time");
  });
}

TEST(PoissonSolver, StartsNoThreads) {
  const auto threads = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/task"), {});
  };
  const auto mesh = unit_square(8, Cells::quadrilaterals, 0.1);
  const auto before = threads();
  PoissonSolver<2>(&mesh, {.degree = 2})
      .solve(mesh.coordinates(), manufactured_solution<2>("quadratic"));
  EXPECT_EQ(threads(), before);
}

TEST(PoissonSolver, SquareOfFourQuadrilateralsMatchesHandComputation) {
  // One free node in the middle of a 2 x 2 grid of squares. The bilinear stiffness is 8/3, so that
  // the condition number is 1, and the solution follows from one equation.
  const auto mesh = unit_square(2, Cells::quadrilaterals, 0.0);
  PoissonOptions options;
  const auto record = PoissonSolver<2>(&mesh, options)
                          .solve(mesh.coordinates(), manufactured_solution<2>("quadratic"));
  EXPECT_EQ(record.n_free, 1U);
  EXPECT_NEAR(record.lambda_max, 8.0 / 3.0, 1e-14);
  EXPECT_NEAR(record.condition_number, 1.0, 1e-14);
  EXPECT_EQ(record.condition_method, "dense");
  EXPECT_LE(record.cg_iterations, 1U);
}

TEST(PoissonSolver, CubeOfEightHexahedraMatchesHandComputation) {
  // One free node in the middle of 2 x 2 x 2 cubes of edge h = 1/2: eight times the integral of
  // |grad phi|^2, 3 (1/h) (h/3) (h/3).
  const auto mesh = unit_cube(2, Cells::hexahedra, 0.0);
  const auto record = PoissonSolver<3>(&mesh, PoissonOptions{})
                          .solve(mesh.coordinates(), manufactured_solution<3>("quadratic"));
  EXPECT_EQ(record.n_free, 1U);
  EXPECT_NEAR(record.lambda_max, 8.0 / 3.0 * 0.5, 1e-14);
  EXPECT_NEAR(record.condition_number, 1.0, 1e-14);
}

/// Compares chosen Gauss points on hexahedra with twenty points in each direction, on a badly and
/// on a hardly distorted box: every recorded number agrees to 1e-4.
TEST(PoissonSolver, ChosenRulesAgreeWithTwentyPointsOnHexahedra) {
  for (const double distortion : {0.1, 0.5})
    for (const int degree : {1, 2})
      for (const bool galerkin : {false, true}) {
        const auto mesh = unit_cube(4, Cells::hexahedra, distortion);
        const auto solve = [&](int n_points) {
          PoissonOptions options{.degree = degree,
                                 .load = galerkin ? Load::quadrature : Load::nodal};
          options.tensor_points.hexahedron = n_points;
          options.cg_tolerance = 1e-10;
          return PoissonSolver<3>(&mesh, options)
              .solve(mesh.coordinates(), manufactured_solution<3>("volume"));
        };
        const auto chosen = solve(0), four = solve(4), twenty = solve(20);
        EXPECT_EQ(chosen.status, "ok");
        EXPECT_EQ(four.most_points, 0) << "they are given";
        EXPECT_GE(chosen.most_points, 6) << "some cell needs more than the first rule";
        double change_of_four = 0.0;
        for (const auto number :
             {&SolutionRecord::condition_number, &SolutionRecord::lambda_min,
              &SolutionRecord::lambda_max, &SolutionRecord::e_max, &SolutionRecord::e_mean,
              &SolutionRecord::e_l2, &SolutionRecord::e_h1, &SolutionRecord::l2_error,
              &SolutionRecord::h1_error}) {
          const auto change = [&](const SolutionRecord& record) {
            return std::abs(record.*number / (twenty.*number) - 1.0);
          };
          EXPECT_LT(change(chosen), 1e-4) << degree << ", " << distortion << ", " << galerkin;
          change_of_four = std::max(change_of_four, change(four));
        }
        if (distortion > 0.4) {
          EXPECT_GT(change_of_four, 1e-4) << "there was something to choose";
        }
      }
}

/// Checks each cell separately, also cells whose determinant counts as constant and which skip the
/// second rule.
TEST(PoissonSolver, StiffnessOfHexahedraWithChosenRulesAgreesWithTwentyPoints) {
  for (const double distortion : {0.15, 0.3, 0.6})
    for (const int degree : {1, 2}) {
      const auto mesh = unit_cube(4, Cells::hexahedra, distortion);
      const auto matrix = [&](int n_points) {
        const auto space =
            make_finite_element_space(&mesh, degree, TensorPoints{.hexahedron = n_points});
        PoissonSystem system = make_system(*space);
        assemble(*space, mesh.copied_coordinates(), manufactured_solution<3>("sine"),
                 Load::quadrature, system);
        return system.matrix;
      };
      const SparseMatrix chosen = matrix(0), twenty = matrix(20);
      for (Eigen::Index i = 0; i < twenty.rows(); ++i)
        EXPECT_NEAR(chosen.coeff(i, i) / twenty.coeff(i, i), 1.0, 1e-4) << distortion;
      EXPECT_LT((chosen - twenty).norm(), 1e-4 * twenty.norm());
    }
}

TEST(PoissonSolver, RefusesPolygonsDegreesAndMeshesWithoutUnknowns) {
  const std::vector<Point<2>> corners{{0, 0}, {1, 0}, {1.3, 0.8}, {0.5, 1.4}, {-0.3, 0.8}};
  const PlanarMesh pentagon(
      std::make_shared<Topology>(2, 5, CompressedRows<NodeIndex>({0, 5}, {0, 1, 2, 3, 4})),
      corners);
  const auto make = []<int dim>(const Mesh<dim>& mesh, int degree) {
    PoissonOptions options;
    options.degree = degree;
    const PoissonSolver<dim> solver(&mesh, options);
  };
  EXPECT_THROW(make(pentagon, 1), InputError);
  EXPECT_THROW(make(unit_square(1, Cells::quadrilaterals, 0.0), 1), InputError);
  EXPECT_THROW(make(unit_square(3, Cells::triangles, 0.0), 3), InputError);
  EXPECT_THROW(make(unit_cube(3, Cells::hexahedra, 0.0), 3), InputError);
  for (const Cells cells : {Cells::tetrahedra, Cells::hexahedra})
    EXPECT_THAT([&] { make(unit_cube(1, cells, 0.0), 1); },
                ThrowsMessage<InputError>(HasSubstr("no unknown")));
}

TEST(PoissonSolver, NamesUnsupportedCells) {
  const auto make = [](test::BoxCells kind) {
    const auto mesh = test::box_mesh(2, 2, 4, kind);
    const PoissonSolver<3> solver(&mesh, PoissonOptions{.degree = 2});
  };
  EXPECT_THAT(
      [&] { make(test::BoxCells::pyramids); },
      ThrowsMessage<InputError>(HasSubstr("cell 0 is a pyramid; finite elements of degree 2")));
  EXPECT_THAT([&] { make(test::BoxCells::prisms); }, ThrowsMessage<InputError>(HasSubstr("prism")));
  EXPECT_THAT([&] { make(test::BoxCells::mixed); }, ThrowsMessage<InputError>(HasSubstr("prism")));
}

TEST(PoissonSolver, NamesTheFirstCellOfAnotherType) {
  // A cube, and on its top a tetrahedron over half of the face: quadratic tetrahedra and hexahedra
  // do not fit together.
  auto mesh = test::box_mesh(1, 1, 1, test::BoxCells::hexahedra);
  auto points = mesh.copied_coordinates();
  points.emplace_back(2.0, 2.0, 2.0);
  auto cells = mesh.topology().cells();
  cells.append(std::vector<NodeIndex>{4, 5, 7, 8});
  EXPECT_THAT(
      [&] {
        const auto both = test::make_volume_mesh(points, cells);
        const PoissonSolver<3> solver(&both, PoissonOptions{.degree = 2});
      },
      ThrowsMessage<InputError>(HasSubstr("tetrahedron among cells of another type")));
}

}  // namespace
}  // namespace smoothfem
