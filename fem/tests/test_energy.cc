// SPDX-License-Identifier: GPL-3.0-or-later
// The energy of a solution, its gradient in node positions, and the indicators read from it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "fem/adaptivity/poisson_problem.h"
#include "fem/poisson_solver.h"
#include "fem/tests/gradient_of_differences.h"
#include "fem/tests/unit_mesh.h"
#include "smoothing/base/parallel.h"

namespace smoothfem {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::vector<Case> energy_cases() {
  auto cases = all_cases();
  std::erase_if(cases, [](const Case& c) {
    return c.cells == Cells::pyramids || c.cells == Cells::prisms || c.cells == Cells::mixed_volume;
  });
  return cases;
}

/// A smooth solution with a load that no rule integrates exactly.
template <int dim>
ManufacturedSolution<dim> smooth_solution() {
  return manufactured_solution<dim>(dim == 2 ? "gear" : "volume");
}

/// A solution in a varying medium, with a tensor whose directions vary, too. f is constant, so that
/// the quadrature error is below the accuracy of differences. For degree 2, whose rules are better,
/// it has an additional part that is not in the space.
template <int dim>
ManufacturedSolution<dim> in_a_medium(int degree) {
  const std::string more = degree == 1 ? "" : " + sin(3*x)*exp(y)";
  return dim == 2 ? derived_solution<dim>("x*y" + more, "1 + y^2, 0.5 ; 0.5, 1 + exp(x)", {})
                  : derived_solution<dim>("x*y + z" + more,
                                          "1 + y*z, 0.5, 0.3*y ; 0.5, 1 + exp(x*z), 0.2*x^2 ; "
                                          "0.3*y, 0.2*x^2, 1 + x",
                                          {});
}

class EnergyTest : public testing::TestWithParam<Case> {
 protected:
  template <int dim>
  static std::unique_ptr<ProblemSolver<dim>> prepared(const Problem<dim>& problem,
                                                      const Mesh<dim>& mesh) {
    auto solver = problem.make_solver();
    solver->prepare(mesh, GetParam().degree);
    return solver;
  }

  /// Mesh and problem move together: energy and indicators stay, and the gradient turns like
  /// directions.
  template <int dim>
  static void expect_alike_after_motion(const Mesh<dim>& mesh, const auto& forward,
                                        const auto& back, const auto& forward_direction) {
    const auto here = smooth_solution<dim>();
    auto there = here;
    there.value = [=](const Point<dim>& p) { return here.value(back(p)); };
    there.load = [=](const Point<dim>& p) { return here.load(back(p)); };
    auto moved = mesh;
    for (auto& p : moved.coordinates()) p = forward(p);
    const auto problem = make_poisson_problem<dim>(here), other = make_poisson_problem<dim>(there);
    const auto first = prepared<dim>(*problem, mesh), second = prepared<dim>(*other, moved);
    const double energy = first->solve(mesh.coordinates());
    EXPECT_NEAR(second->solve(moved.coordinates()), energy, 1e-9 * std::abs(energy));
    const auto a = first->energy_gradient(), b = second->energy_gradient();
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      EXPECT_LT((forward_direction(a[i]) - b[i]).norm(), 1e-7 * std::abs(energy)) << i;
    const auto e = first->recovery_indicators(), f = second->recovery_indicators();
    for (std::size_t c = 0; c < e.size(); ++c) EXPECT_NEAR(e[c], f[c], 1e-7 * (1.0 + e[c]));
  }
};

TEST_P(EnergyTest, GradientAgreesWithDifferences) {
  GetParam().on_mesh(6, 4, 0.15, []<int dim>(const Mesh<dim>& mesh) {
    for (const auto& solution : {smooth_solution<dim>(), in_a_medium<dim>(GetParam().degree)}) {
      const auto problem = make_poisson_problem<dim>(solution);
      expect_gradient_of_differences(*prepared<dim>(*problem, mesh), mesh);
    }
  });
}

/// A constant tensor is equivalent to a change of coordinates, and the identity to no change.
TEST_P(EnergyTest, AcceptsTheIdentityAsDiffusivity) {
  GetParam().on_mesh(5, 3, 0.15, []<int dim>(const Mesh<dim>& mesh) {
    const auto plain = make_poisson_problem<dim>(derived_solution<dim>("exp(x)*y + y^3", {}, {}));
    const auto given = make_poisson_problem<dim>(derived_solution<dim>("exp(x)*y + y^3", "1", {}));
    const auto a = prepared<dim>(*plain, mesh), b = prepared<dim>(*given, mesh);
    const double energy = a->solve(mesh.coordinates());
    EXPECT_NEAR(b->solve(mesh.coordinates()), energy, 1e-9 * std::abs(energy));
    const auto g = a->energy_gradient(), h = b->energy_gradient();
    for (std::size_t i = 0; i < g.size(); ++i) EXPECT_LT((g[i] - h[i]).norm(), 1e-8);
    const auto e = a->recovery_indicators(), f = b->recovery_indicators();
    const auto r = a->residual_indicators(), s = b->residual_indicators();
    for (std::size_t c = 0; c < e.size(); ++c) {
      EXPECT_NEAR(e[c], f[c], 1e-8);
      EXPECT_NEAR(r[c], s[c], 1e-6);
    }
  });
}

/// If all fluxes are k times as large, so are energies and the squares of all indicators.
TEST_P(EnergyTest, ScalesWithTheDiffusivity) {
  GetParam().on_mesh(5, 3, 0.15, []<int dim>(const Mesh<dim>& mesh) {
    const auto once = make_poisson_problem<dim>(derived_solution<dim>("exp(x)*y", "1 + x", {}));
    const auto more = make_poisson_problem<dim>(derived_solution<dim>("exp(x)*y", "9 + 9*x", {}));
    const auto a = prepared<dim>(*once, mesh), b = prepared<dim>(*more, mesh);
    const double energy = a->solve(mesh.coordinates());
    EXPECT_NEAR(b->solve(mesh.coordinates()), 9.0 * energy, 1e-8 * std::abs(energy));
    const auto e = a->recovery_indicators(), f = b->recovery_indicators();
    const auto r = a->residual_indicators(), s = b->residual_indicators();
    const auto t = a->recovery_tensors(), v = b->recovery_tensors();
    for (std::size_t c = 0; c < e.size(); ++c) {
      EXPECT_NEAR(3.0 * e[c], f[c], 1e-6);
      EXPECT_NEAR(3.0 * r[c], s[c], 1e-5);
      EXPECT_NEAR(t[c].trace(), e[c] * e[c], 1e-10);
      EXPECT_LT((9.0 * t[c] - v[c]).norm(), 1e-6);
    }
  });
}

/// |grad(u - u_h)|^2 = J + const: between two meshes with the same boundary both change equally.
TEST_P(EnergyTest, ChangesAsTheSquareOfTheTrueErrorDoes) {
  GetParam().on_mesh(6, 4, 0.15, []<int dim>(const Mesh<dim>& mesh) {
    const auto solution = smooth_solution<dim>();
    auto even = mesh;
    even.set_coordinates(unit_mesh<dim>(dim == 2 ? 6 : 4, GetParam().cells, 0.0).coordinates());
    const PoissonOptions options{.degree = GetParam().degree,
                                 .load = Load::quadrature,
                                 .cg_tolerance = 1e-12,
                                 .condition_number = ConditionNumberMethod::none,
                                 .jacobi_cg = Recorded::never};
    PoissonSolver<dim> errors(&mesh, options);
    const auto problem = make_poisson_problem<dim>(solution);
    const auto solver = prepared<dim>(*problem, mesh);
    const auto square = [&](const Mesh<dim>& m) {
      const auto record = errors.solve(m.coordinates(), solution);
      return record.h1_error * record.h1_error - record.l2_error * record.l2_error;
    };
    const double before = square(mesh), after = square(even);
    EXPECT_NEAR(solver->solve(mesh.coordinates()) - solver->solve(even.coordinates()),
                before - after, 1e-3 * std::abs(before - after));
  });
}

TEST_P(EnergyTest, FollowsTheProblemWhereItMoves) {
  GetParam().on_mesh(5, 3, 0.15, []<int dim>(const Mesh<dim>& mesh) {
    const Point<dim> shift = Point<dim>::LinSpaced(3.0, -2.0);
    expect_alike_after_motion<dim>(
        mesh, [=](const Point<dim>& p) -> Point<dim> { return p + shift; },
        [=](const Point<dim>& p) -> Point<dim> { return p - shift; },
        [](const Point<dim>& direction) { return direction; });
  });
}

/// A quarter of a turn about the z axis, which causes no rounding.
TEST_P(EnergyTest, TurnsWithTheProblem) {
  GetParam().on_mesh(5, 3, 0.15, []<int dim>(const Mesh<dim>& mesh) {
    const auto turned = [](Point<dim> p, double sign) {
      const double x = p[0];
      p[0] = -sign * p[1];
      p[1] = sign * x;
      return p;
    };
    const auto forward = [=](const Point<dim>& p) { return turned(p, 1.0); };
    expect_alike_after_motion<dim>(
        mesh, forward, [=](const Point<dim>& p) { return turned(p, -1.0); }, forward);
  });
}

TEST_P(EnergyTest, IsBitwiseIdenticalForEveryNumberOfThreads) {
  const int default_threads = n_threads();
  GetParam().on_mesh(30, 8, 0.15, []<int dim>(const Mesh<dim>& mesh) {
    const auto problem = make_poisson_problem<dim>(smooth_solution<dim>());
    double energy = 0.0;
    std::vector<Point<dim>> gradient;
    std::vector<double> indicators, residuals;
    std::vector<CellTensor<dim>> tensors;
    for (const int threads : {1, 2, 3}) {
      set_n_threads(threads);
      const auto solver = prepared<dim>(*problem, mesh);
      const double value = solver->solve(mesh.coordinates());
      if (threads == 1) {
        energy = value;
        gradient = solver->energy_gradient();
        indicators = solver->recovery_indicators();
        residuals = solver->residual_indicators();
        tensors = solver->recovery_tensors();
      }
      EXPECT_EQ(value, energy);
      EXPECT_EQ(solver->energy_gradient(), gradient);
      EXPECT_EQ(solver->recovery_indicators(), indicators);
      EXPECT_EQ(solver->residual_indicators(), residuals);
      EXPECT_EQ(solver->recovery_tensors(), tensors);
    }
  });
  set_n_threads(default_threads);
}

/// A solution in the space has no error, nothing to gain, and nothing to recover.
TEST_P(EnergyTest, HasNoGradientWhereTheSolutionIsExact) {
  GetParam().on_mesh(4, 3, 0.15, []<int dim>(const Mesh<dim>& mesh) {
    const auto problem = make_poisson_problem<dim>(manufactured_solution<dim>("linear"));
    const auto solver = prepared<dim>(*problem, mesh);
    solver->solve(mesh.coordinates());
    for (const auto& g : solver->energy_gradient()) EXPECT_LT(g.norm(), 1e-8);
    for (const double e : solver->recovery_indicators()) EXPECT_LT(e, 1e-7);
  });
}

/// Indicators and the error of degree 1 fall at the same rate under refinement.
TEST_P(EnergyTest, RecoveryEstimatesTheSizeOfTheError) {
  if (GetParam().cells == Cells::mixed) GTEST_SKIP() << "cells of two sizes";
  with_dimension(dimension_of(GetParam().cells), []<int dim>() {
    const auto solution = smooth_solution<dim>();
    const auto ratio = [&](std::size_t n) {
      const auto mesh = unit_mesh<dim>(n, GetParam().cells, 0.0);
      const auto problem = make_poisson_problem<dim>(solution);
      const auto solver = prepared<dim>(*problem, mesh);
      solver->solve(mesh.coordinates());
      const auto indicators = solver->recovery_indicators();
      EXPECT_EQ(indicators.size(), mesh.n_cells());
      double square = 0.0;  // of cells of one size
      for (const double e : indicators) square += e * e / static_cast<double>(mesh.n_cells());
      PoissonSolver<dim> errors(&mesh, {.degree = 1,
                                        .load = Load::quadrature,
                                        .condition_number = ConditionNumberMethod::none,
                                        .jacobi_cg = Recorded::never});
      return std::sqrt(square) / errors.solve(mesh.coordinates(), solution).h1_error;
    };
    const double coarse = ratio(dim == 2 ? 12 : 6), fine = ratio(dim == 2 ? 24 : 12);
    EXPECT_GT(fine, 0.3);
    EXPECT_LT(fine, 3.0);
    EXPECT_LT(coarse, 1.5 * fine);
    EXPECT_GT(coarse, 0.67 * fine);
  });
}

/// Their traces are the squares of the indicators. If the solution changes along x alone on a
/// product mesh, the gradient's error points along x.
TEST_P(EnergyTest, RecoveryTensorsHaveTheDirectionOfTheError) {
  if (GetParam().cells == Cells::mixed) GTEST_SKIP() << "cells of two sizes";
  with_dimension(dimension_of(GetParam().cells), []<int dim>() {
    const auto mesh = unit_mesh<dim>(6, GetParam().cells, 0.1);
    const auto problem = make_poisson_problem<dim>(derived_solution<dim>("x^3", {}, {}));
    const auto solver = prepared<dim>(*problem, mesh);
    solver->solve(mesh.coordinates());
    const auto indicators = solver->recovery_indicators();
    const auto tensors = solver->recovery_tensors();
    ASSERT_EQ(tensors.size(), indicators.size());
    CellTensor<dim> sum = CellTensor<dim>::Zero();
    for (std::size_t c = 0; c < tensors.size(); ++c) {
      EXPECT_NEAR(tensors[c].trace(), indicators[c] * indicators[c], 1e-12);
      EXPECT_EQ(tensors[c](0, 1), tensors[c](1, 0));
      sum += tensors[c];
    }
    EXPECT_GT(sum(0, 0), 0.9 * sum.trace());
  });
}

INSTANTIATE_TEST_SUITE_P(Elements, EnergyTest, testing::ValuesIn(energy_cases()),
                         [](const auto& info) { return name_of(info.param); });

TEST(Energy, CountsSolvesOncePerMesh) {
  const auto mesh = unit_square(4, Cells::triangles, 0.1);
  const auto problem = make_poisson_problem<2>(smooth_solution<2>());
  const auto solver = problem->make_solver();
  solver->prepare(mesh, 1);
  const double energy = solver->solve(mesh.coordinates());
  EXPECT_EQ(solver->solve(mesh.coordinates()), energy);
  EXPECT_EQ(solver->effort().n_solves, 1u);
  EXPECT_GT(solver->effort().seconds, 0.0);
  solver->prepare(mesh, 2);
  EXPECT_LT(solver->solve(mesh.coordinates()), energy) << "a larger space has less energy";
  EXPECT_EQ(solver->effort().n_solves, 2u);
}

/// A load that rules with few points miss: it oscillates within a cell.
TEST(Energy, ResolvesSharpLoads) {
  ManufacturedSolution<2> sharp = manufactured_solution<2>("sine");
  sharp.value = [](const Point<2>&) { return 0.0; };
  sharp.load = [](const Point<2>& p) {
    return std::exp(-4e3 * (p - Point<2>(0.31, 0.33)).squaredNorm());
  };
  const auto energy_on = [&](std::size_t n) {
    const auto mesh = unit_square(n, Cells::triangles, 0.0);
    const auto problem = make_poisson_problem<2>(sharp);
    const auto solver = problem->make_solver();
    solver->prepare(mesh, 2);
    return solver->solve(mesh.coordinates());
  };
  // With half of the load missing the energy would be a quarter.
  EXPECT_NEAR(energy_on(8), energy_on(32), 0.2 * std::abs(energy_on(32)));
}

TEST(Energy, RefusesUnsupportedInput) {
  const auto mesh = unit_square(3, Cells::triangles, 0.1);
  auto diffusive = smooth_solution<2>();
  diffusive.diffusivity = [](const Point<2>&) -> Diffusivity<2> {
    return Diffusivity<2>::Identity();
  };
  const auto problem = make_poisson_problem<2>(diffusive);
  EXPECT_THAT([&] { problem->make_solver()->prepare(mesh, 1); },
              ThrowsMessage<InputError>(HasSubstr("give the diffusivity as a formula")));
  const Mesh<2> loose(std::make_shared<const Topology>(2, mesh.n_nodes(), mesh.topology().cells(),
                                                       std::vector<bool>(mesh.n_nodes(), false)),
                      mesh.copied_coordinates());
  const auto known = make_poisson_problem<2>(smooth_solution<2>());
  EXPECT_THAT([&] { known->make_solver()->prepare(loose, 1); },
              ThrowsMessage<InputError>(HasSubstr("boundary is not fixed")));
  const auto volume = make_poisson_problem<3>(smooth_solution<3>());
  EXPECT_THAT([&] { volume->make_solver()->prepare(unit_cube(2, Cells::prisms, 0.0), 1); },
              ThrowsMessage<InputError>(HasSubstr("pyramids and prisms")));
}

}  // namespace
}  // namespace smoothfem
