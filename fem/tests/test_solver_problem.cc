// SPDX-License-Identifier: GPL-3.0-or-later
// Methods that move nodes by the solution of any solver: its energy, its gradient, its indicators.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <optional>

#include "fem/adaptivity/solver_problem.h"
#include "fem/poisson_solver.h"
#include "fem/tests/configured_solver.h"
#include "fem/tests/gradient_of_differences.h"
#include "fem/tests/unit_mesh.h"
#include "smoothing/loop/smooth.h"

namespace smoothfem {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

template <int dim>
MakeMeshSolver<dim> maker(const Mesh<dim>& mesh, const std::string& type, const Settings& settings,
                          const Keyed& keyed = {},
                          const std::optional<ManufacturedSolution<dim>>& solution = {}) {
  return [=](int degree) {
    auto made = configured_solver<dim>(type, settings, keyed);
    if (solution) made->use_solution(*solution);
    made->initialize(mesh, degree);
    return made;
  };
}

class EnergyOfCells : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Elements, EnergyOfCells, testing::ValuesIn(cases_of_deal_ii()),
                         [](const auto& info) { return name_of(info.param); });

/// The load is a constant, so that all rules integrate it exactly on simplices and parallelograms.
TEST_P(EnergyOfCells, GradientOfElasticityIsThatOfDifferences) {
  GetParam().on_mesh(3, 2, 0.1, [&]<int dim>(const Mesh<dim>& mesh) {
    const auto problem = make_solver_problem<dim>(
        mesh,
        maker(mesh, "elasticity", {{"f", dim == 2 ? "1 ; -2" : "1 ; -2 ; 3"}, {"nu", "0.4"}},
              {{"displacement group", "boundary", dim == 2 ? "x*y ; 0.1" : "x*y ; 0.1 ; z"}}));
    const auto solver = problem->make_solver();
    solver->prepare(mesh, GetParam().degree);
    expect_gradient_of_differences(*solver, mesh);
  });
}

/// Materials of groups move with their cells; tractions are on a boundary that stays.
TEST(EnergyOfElasticity, HasMaterialsAndTractions) {
  const auto mesh = with_groups(unit_cube(2, Cells::tetrahedra, 0.1));
  const auto solver =
      make_solver_problem<3>(mesh, maker(mesh, "elasticity", {{"f", "0 ; 0 ; 1"}},
                                         {{"displacement group", "side", "0 ; 0 ; 0"},
                                          {"traction group", "right", "1 ; 2 ; 0"}}))
          ->make_solver();
  solver->prepare(mesh, 2);
  expect_gradient_of_differences(*solver, mesh);
}

TEST(EnergyOfElasticity, FallsWithTheErrorInTheEnergyNorm) {
  const Mesh<2> mesh = unit_square(6, Cells::triangles, 0.3);
  const auto make =
      maker<2>(mesh, "elasticity", {{"u", "exp(-8*x)*y ; exp(-8*y)"}, {"cg_tolerance", "1e-12"}});
  const auto problem = make_solver_problem<2>(mesh, make);
  auto method = make_method<2>("energy-lbfgs");
  method.problem = problem;
  Mesh<2> smoothed = mesh;
  smooth(smoothed, method);

  const auto squared_error = [&](const Mesh<2>& m) {
    double error = 0.0;
    for (const auto& [name, value] : make(1)->solve(m).numbers)
      if (name == "energy_error") error = value;
    return error * error;
  };
  const double before = squared_error(mesh), after = squared_error(smoothed);
  EXPECT_LT(after, 0.8 * before);
  const auto solver = problem->make_solver();
  solver->prepare(mesh, 1);
  const double change = solver->solve(smoothed.coordinates()) - solver->solve(mesh.coordinates());
  EXPECT_NEAR(after - before, change, 0.01 * (before - after));
}

/// The fast path's residual indicator has the jumps, too; both rank the cells alike.
TEST(Indicators, OfKellyAreHighWhereTheFastPathsAre) {
  const Mesh<2> mesh = unit_square(8, Cells::triangles, 0.2);
  const auto solution = derived_solution<2>("exp(-10*x)*cos(y)", {}, {});
  const auto solver =
      make_solver_problem<2>(mesh, maker<2>(mesh, "deal.II", {}, {}, solution))->make_solver();
  solver->prepare(mesh, 1);
  EXPECT_EQ(solver->solve(mesh.coordinates()), 0.0);
  const auto indicators = solver->residual_indicators();
  ASSERT_EQ(indicators.size(), mesh.n_cells());
  double left = 0.0, right = 0.0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const bool is_left = mesh.coordinates()[mesh.topology().cell_nodes(c)[0]][0] < 0.3;
    (is_left ? left : right) = std::max(is_left ? left : right, indicators[c]);
  }
  EXPECT_GT(left, 5.0 * right);
}

/// deal.II would read quadrature points that facets of two shapes do not have.
TEST(Indicators, OfKellyAreRefusedOnPyramidsAndPrisms) {
  for (const Cells cells : {Cells::pyramids, Cells::prisms}) {
    const auto mesh = unit_cube(2, cells, 0.0);
    const auto solver = maker<3>(mesh, "deal.II", {}, {}, derived_solution<3>("x*y", {}, {}))(1);
    EXPECT_THAT([&] { (void)solver->indicators(mesh); },
                ThrowsMessage<SolverFailure>(HasSubstr("not of pyramids or prisms")));
    for (const auto& number : solver->solve(mesh).numbers) EXPECT_NE(number.name, "kelly_estimate");
  }
}

TEST(Indicators, OfAnySolverMoveNodes) {
  const Mesh<2> mesh = unit_square(10, Cells::quadrilaterals, 0.3);
  const auto solution = derived_solution<2>("exp(-10*x)*cos(y) + x*y", {}, {});
  for (const auto& [type, settings] :
       {std::pair<std::string, Settings>{"deal.II", {}},
        {"convection-diffusion", {{"diffusion", "1"}, {"velocity", "1 ; 0"}}}}) {
    Mesh<2> started = mesh, smoothed = mesh;
    auto getme = make_method<2>("getme"), method = make_method<2>("indicator-weighted");
    smooth(started, getme);
    method.problem = make_solver_problem<2>(mesh, maker<2>(mesh, type, settings, {}, solution));
    smooth(smoothed, method);
    PoissonSolver<2> poisson(&mesh, {.load = Load::quadrature});
    EXPECT_LT(poisson.solve(smoothed.coordinates(), solution).h1_error,
              0.9 * poisson.solve(started.coordinates(), solution).h1_error)
        << type;
  }
}

/// J = sum of |x_i - 1/2|^2 over the nodes; what it gives can be made wrong.
class OfSprings final : public MeshSolver<2> {
 public:
  enum class Fault { none, energy, gradient, indicators, failure };
  OfSprings(Fault fault, SolverTraits traits) : fault_(fault), traits_(traits) {}
  SolverTraits traits() const override { return traits_; }
  void initialize(const Mesh<2>& /*mesh*/, int /*degree*/) override {}
  SolverResult solve(const Mesh<2>& /*mesh*/) override { return {}; }
  double energy(const Mesh<2>& mesh) override {
    if (fault_ == Fault::failure) throw SolverFailure("the licence has expired");
    if (fault_ == Fault::energy) return std::numeric_limits<double>::quiet_NaN();
    gradient_.clear();
    double sum = 0.0;
    for (const auto& x : mesh.coordinates()) {
      gradient_.emplace_back(2.0 * (x - Point<2>(0.5, 0.5)));
      sum += (x - Point<2>(0.5, 0.5)).squaredNorm();
    }
    return sum;
  }
  std::vector<Point<2>> energy_gradient() override {
    if (fault_ == Fault::gradient) gradient_.pop_back();
    return gradient_;
  }
  std::vector<double> indicators(const Mesh<2>& mesh) override {
    return std::vector<double>(mesh.n_cells(), fault_ == Fault::indicators ? -1.0 : 1.0);
  }

 private:
  Fault fault_;
  SolverTraits traits_;
  std::vector<Point<2>> gradient_;
};

double smooth_by_springs(const std::string& name, OfSprings::Fault fault, SolverTraits traits) {
  const Mesh<2> mesh = unit_square(4, Cells::quadrilaterals, 0.2);
  auto method = make_method<2>(name);
  method.problem =
      make_solver_problem<2>(mesh, [=](int) { return std::make_unique<OfSprings>(fault, traits); });
  const auto energy = [](const Mesh<2>& m) {
    return OfSprings(OfSprings::Fault::none, {}).energy(m);
  };
  Mesh<2> smoothed = mesh;
  smooth(smoothed, method);
  return energy(smoothed) / energy(mesh);
}

TEST(AnySolver, LowersItsEnergy) {
  EXPECT_LT(smooth_by_springs("energy-lbfgs", OfSprings::Fault::none, {.has_energy = true}), 0.99);
}

TEST(AnySolver, ThatGivesNonsenseIsNamed) {
  using Fault = OfSprings::Fault;
  const auto expect = [](const std::string& method, Fault fault, SolverTraits traits,
                         const std::string& text) {
    EXPECT_THAT([&] { smooth_by_springs(method, fault, traits); },
                ThrowsMessage<SmootherFailure>(HasSubstr(text)));
  };
  expect("energy-lbfgs", Fault::failure, {.has_energy = true}, "the licence has expired");
  expect("energy-lbfgs", Fault::energy, {.has_energy = true},
         "'energy' does not give a finite number");
  expect("energy-lbfgs", Fault::gradient, {.has_energy = true},
         "'energy_gradient' does not give a finite vector for each node");
  expect("indicator-weighted", Fault::indicators, {.has_indicators = true},
         "'indicators' does not give a finite number for each cell that is not negative");
  expect("energy-lbfgs", Fault::none, {.has_indicators = true}, "gives no energy");
  expect("indicator-getme", Fault::none, {.has_energy = true}, "gives no error indicators");
  expect("indicator-mmpde", Fault::none, {.has_indicators = true}, "no second derivatives");
}

}  // namespace
}  // namespace smoothfem
