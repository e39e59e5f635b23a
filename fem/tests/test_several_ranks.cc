// SPDX-License-Identifier: GPL-3.0-or-later
// Run by mpirun: records must not depend on the number of processes. Each rank runs every test,
// the root alone reports.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <iostream>
#include <limits>

#include "fem/adaptivity/energy_solver.h"
#include "fem/materials/materials_of_mesh.h"
#include "fem/poisson_solver.h"
#include "fem/solvers/mesh_solver.h"
#include "fem/tests/all_ranks.h"
#include "fem/tests/same_record.h"
#include "fem/tests/second_order.h"

namespace smoothfem {
namespace {

using test::all_ranks;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Arguments of the root.
template <int dim>
const Mesh<dim>* on_root(const Mesh<dim>& mesh) {
  return all_ranks().is_root() ? &mesh : nullptr;
}

class SeveralRanksTest : public testing::TestWithParam<Case> {
 protected:
  /// The CG iterates of two runs agree to 1e-8 only if they are converged further than that.
  static PoissonOptions options() {
    PoissonOptions options;
    options.degree = GetParam().degree;
    options.cg_tolerance = 1e-14;
    return options;
  }
};

INSTANTIATE_TEST_SUITE_P(Elements, SeveralRanksTest, testing::ValuesIn(all_cases()),
                         [](const auto& info) { return name_of(info.param); });

TEST_P(SeveralRanksTest, RecordAndNodalErrorsEqualThoseOfOneProcess) {
  for (const bool galerkin : {false, true})
    GetParam().on_mesh(14, 7, 0.25, [&]<int dim>(const Mesh<dim>& mesh) {
      const auto& solution = manufactured_solution<dim>(dim == 2 ? "gear" : "volume");
      auto both = options();
      both.load = galerkin ? Load::quadrature : Load::nodal;
      both.boundary_in_norm = galerkin;
      PoissonSolver<dim> solver(on_root(mesh), both, all_ranks());
      const auto record = solver.solve(mesh.coordinates(), solution);
      const auto errors = solver.nodal_errors();
      if (!all_ranks().is_root()) {
        EXPECT_TRUE(errors.empty());
        return;
      }
      PoissonSolver<dim> single(&mesh, both);
      expect_same(record, single.solve(mesh.coordinates(), solution));
      const auto expected = single.nodal_errors();
      ASSERT_EQ(errors.size(), expected.size());
      for (std::size_t i = 0; i < errors.size(); ++i)
        EXPECT_NEAR(errors[i], expected[i], 1e-8 * record.e_max);
    });
}

TEST_P(SeveralRanksTest, CurvedCellsEqualThoseOfOneProcess) {
  for (const bool complete : {false, true})
    GetParam().on_mesh(8, 4, 0.2, [&]<int dim>(const Mesh<dim>& linear) {
      auto mesh = second_order(with_groups(linear), complete, shell_of_unit<dim>);
      const auto& solution = manufactured_solution<dim>("sine");
      auto natural = options();
      natural.load = Load::quadrature;
      natural.natural_groups = {"right"};
      if (natural.degree == 2) {  // boundary values of midside nodes
        auto straight = natural;
        straight.geometry = Geometry::straight;
        const auto record = PoissonSolver<dim>(on_root(mesh), straight, all_ranks())
                                .solve(mesh.coordinates(), solution);
        if (all_ranks().is_root())
          expect_same(record,
                      PoissonSolver<dim>(&mesh, straight).solve(mesh.coordinates(), solution));
      }
      PoissonSolver<dim> solver(on_root(mesh), natural, all_ranks());
      const auto record = solver.solve(mesh.coordinates(), solution);
      const auto errors = solver.nodal_errors();
      if (all_ranks().is_root()) {
        PoissonSolver<dim> single(&mesh, natural);
        expect_same(record, single.solve(mesh.coordinates(), solution));
        const auto expected = single.nodal_errors();
        ASSERT_EQ(errors.size(), expected.size());
        for (std::size_t i = 0; i < errors.size(); ++i)
          EXPECT_NEAR(errors[i], expected[i], 1e-8 * record.e_max);
      }
      // All ranks throw for a folded cell of one of them.
      const NodeIndex node = mesh.topology().midside_nodes(0)[0];
      mesh.coordinates()[node] = mesh.coordinates()[mesh.topology().cell_nodes(0)[2]];
      EXPECT_THAT([&] { (void)solver.solve(mesh.coordinates(), solution); },
                  ThrowsMessage<CellError>(HasSubstr("is folded inside")));
    });
}

TEST_P(SeveralRanksTest, UserProblemsEqualThoseOfOneProcess) {
  GetParam().on_mesh(14, 7, 0.25, [&]<int dim>(const Mesh<dim>& plain) {
    const auto mesh = with_groups(plain);
    const auto solution = dim == 2
                              ? derived_solution<dim>("sin(2*x)*y^2", "2, x/2 ; x/2, 1 + y", {})
                              : derived_solution<dim>("sin(2*x)*y^2 + z", "1 + x*y", {});
    auto natural = options();
    natural.natural_groups = {"right", "side"};
    const auto record =
        PoissonSolver<dim>(on_root(mesh), natural, all_ranks()).solve(mesh.coordinates(), solution);
    if (!all_ranks().is_root()) return;
    expect_same(record, PoissonSolver<dim>(&mesh, natural).solve(mesh.coordinates(), solution));
  });
}

TEST_P(SeveralRanksTest, MaterialsEqualThoseOfOneProcess) {
  with_dimension(dimension_of(GetParam().cells), [&]<int dim>() {
    const auto mesh = two_materials<dim>(dim == 2 ? 14 : 8, GetParam().cells, 0.2);
    auto solution = derived_solution<dim>("if(x < 0.5, x - 0.5, (x - 0.5)/4) + sin(3*y)", "", {},
                                          {{"right", "4"}, {"1", "cos(y)/cos(y)"}});
    // Only the root knows the mesh.
    if (all_ranks().is_root()) solution = with_materials_of(solution, mesh);
    auto natural = options();
    natural.natural_groups = {"right"};
    const auto record =
        PoissonSolver<dim>(on_root(mesh), natural, all_ranks()).solve(mesh.coordinates(), solution);
    if (!all_ranks().is_root()) return;
    expect_same(record, PoissonSolver<dim>(&mesh, natural).solve(mesh.coordinates(), solution));
  });
}

TEST_P(SeveralRanksTest, TiedNodesEqualThoseOfOneProcess) {
  if (GetParam().degree > 1) GTEST_SKIP() << "ties are for degree 1";
  GetParam().on_mesh(14, 7, 0.25, [&]<int dim>(const Mesh<dim>& mesh) {
    const auto solution = derived_solution<dim>("sin(2*pi*x + 1)*cos(y)", "", {});
    auto periodic = options();
    periodic.load = Load::quadrature;
    periodic.ties = std::make_shared<const NodeTies>(periodic_in_x(mesh));
    const auto alone = periodic;
    if (!all_ranks().is_root()) periodic.ties = nullptr;  // only the root knows the mesh
    PoissonSolver<dim> solver(on_root(mesh), periodic, all_ranks());
    const auto record = solver.solve(mesh.coordinates(), solution);
    const auto errors = solver.nodal_errors();
    if (!all_ranks().is_root()) return;
    PoissonSolver<dim> single(&mesh, alone);
    expect_same(record, single.solve(mesh.coordinates(), solution));
    const auto expected = single.nodal_errors();
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(errors[i], expected[i], 1e-8 * record.e_max);
  });
}

TEST_P(SeveralRanksTest, AllRanksHaveTheSameRecord) {
  GetParam().on_mesh(14, 7, 0.25, [&]<int dim>(const Mesh<dim>& mesh) {
    const auto record = PoissonSolver<dim>(on_root(mesh), options(), all_ranks())
                            .solve(mesh.coordinates(), manufactured_solution<dim>("sine"));
    std::array numbers{record.condition_number, record.e_max, record.e_h1, record.l2_error,
                       static_cast<double>(record.cg_iterations)};
    const auto own = numbers;
    all_ranks().broadcast(numbers);
    EXPECT_EQ(own, numbers);
  });
}

TEST_P(SeveralRanksTest, EigenvectorsSurviveGatheringOnTheRoot) {
  GetParam().on_mesh(14, 7, 0.25, [&]<int dim>(const Mesh<dim>& mesh) {
    PoissonSolver<dim> solver(on_root(mesh), options(), all_ranks());
    const auto& solution = manufactured_solution<dim>("sine");
    const auto first = solver.solve(mesh.coordinates(), solution);
    const auto vectors = solver.eigenvectors();
    // Planar meshes on one process, and few dofs, need none.
    const bool kept = first.condition_method == "krylov-schur+lobpcg";
    EXPECT_EQ(vectors.size(), all_ranks().is_root() && kept ? 2 * first.n_free : 0);
    PoissonSolver<dim> next(on_root(mesh), options(), all_ranks());
    next.set_eigenvectors(vectors);
    EXPECT_EQ(next.eigenvectors(), vectors);
    const auto second = next.solve(mesh.coordinates(), solution);
    EXPECT_LE(second.condition_residual, 1e-6);
    expect_relative(second.condition_number, first.condition_number, 1e-9, "condition number");
    next.set_eigenvectors(std::vector<double>(all_ranks().is_root() ? 3 : 0, 1.0));
    EXPECT_TRUE(next.eigenvectors().empty());
  });
}

/// Within the convergence of CG.
template <int dim>
void expect_same_energy(const Mesh<dim>& mesh, const ManufacturedSolution<dim>& solution,
                        const std::vector<std::string>& natural_groups) {
  const int degree = SeveralRanksTest::GetParam().degree;
  const auto solver =
      make_energy_solver(on_root(mesh), degree, solution, natural_groups, all_ranks());
  const bool is_root = all_ranks().is_root();
  const auto coordinates = is_root ? std::span(mesh.coordinates()) : std::span<const Point<dim>>();
  for (int repeat = 0; repeat < 2; ++repeat) {
    const double energy = solver->solve(coordinates);
    const auto gradient = solver->gradient();
    const auto function = solver->function();
    double of_root = energy;
    all_ranks().broadcast(of_root);
    EXPECT_EQ(energy, of_root);
    if (!is_root) continue;
    const auto alone = make_energy_solver(&mesh, degree, solution, natural_groups);
    const double expected = alone->solve(mesh.coordinates());
    EXPECT_NEAR(energy, expected, 1e-9 * std::abs(expected));
    const auto expected_gradient = alone->gradient();
    double largest = 0.0;
    for (const auto& g : expected_gradient) largest = std::max(largest, g.norm());
    ASSERT_EQ(gradient.size(), expected_gradient.size());
    for (std::size_t i = 0; i < gradient.size(); ++i)
      EXPECT_LT((gradient[i] - expected_gradient[i]).norm(), 1e-7 * largest);
    const auto expected_function = alone->function();
    EXPECT_EQ(function.x, expected_function.x);
    ASSERT_EQ(function.u.size(), expected_function.u.size());
    EXPECT_LT((function.u - expected_function.u).norm(), 1e-8 * expected_function.u.norm());
  }
}

TEST_P(SeveralRanksTest, EnergyAndItsGradientEqualThoseOfOneProcess) {
  GetParam().on_mesh(14, 7, 0.2, [&]<int dim>(const Mesh<dim>& plain) {
    const auto& smooth = manufactured_solution<dim>(dim == 2 ? "gear" : "volume");
    const Cells cells = GetParam().cells;
    if (cells == Cells::pyramids || cells == Cells::prisms || cells == Cells::mixed_volume) {
      // All ranks refuse them, whichever has such cells.
      EXPECT_THROW(make_energy_solver(on_root(plain), 1, smooth, {}, all_ranks()), InputError);
      return;
    }
    expect_same_energy<dim>(plain, smooth, {});
    expect_same_energy<dim>(with_groups(plain),
                            dim == 2
                                ? derived_solution<dim>("sin(2*x)*y^2", "2, x/2 ; x/2, 1 + y", {})
                                : derived_solution<dim>("sin(2*x)*y^2 + z", "1 + x*y", {}),
                            {"right"});
  });
}

using Settings = std::vector<std::pair<std::string, std::string>>;
using Keyed = std::vector<std::array<std::string, 3>>;  ///< parameter, name, value

/// A solver of deal.II, with settings.
struct Chosen {
  std::string type;
  int degree;
  Settings settings = {};
  Keyed keyed = {};

  std::unique_ptr<MeshSolver<3>> make() const {
    auto made = make_solver<3>(type);
    EXPECT_TRUE(made->traits().takes_ranks);
    for (const auto& [name, value] : settings)
      set_value(find_parameter(made->parameters(), name, type), value, type);
    for (const auto& [parameter, name, value] : keyed) made->set_keyed(parameter, name, value);
    made->check_parameters();
    if (made->traits().needs_solution)
      made->use_solution(derived_solution<3>("sin(2*x)*exp(y) + z^2", "", {}));
    return made;
  }
};

void expect_same_numbers(const SolverResult& result, const SolverResult& alone) {
  EXPECT_EQ(result.status, alone.status);
  ASSERT_EQ(result.numbers.size(), alone.numbers.size());
  for (std::size_t i = 0; i < result.numbers.size(); ++i) {
    const auto& [name, value] = result.numbers[i];
    const double expected = alone.numbers[i].value;
    EXPECT_EQ(name, alone.numbers[i].name);
    // Multigrid aggregates on each rank separately.
    if (name.ends_with("_seconds") || name == "amg_cg_iterations") continue;
    if (name.ends_with("iterations"))  // one process has another format, and adds in another order
      EXPECT_NEAR(value, expected, std::max(3.0, 0.03 * expected)) << name;
    else if (std::isnan(expected))
      EXPECT_TRUE(std::isnan(value)) << name;
    else
      EXPECT_NEAR(value, expected,
                  (name.ends_with("condition_number") ? 1e-4 : 1e-8) * std::abs(expected))
          << name;
  }
}

/// Solves on two meshes of one topology. Only the root's solver gets them.
void expect_same_on_all_ranks(const Chosen& chosen, const VolumeMesh& first,
                              const VolumeMesh& second) {
  const auto shared = chosen.make(), alone = chosen.make();
  const bool is_root = all_ranks().is_root();
  const VolumeMesh none = unit_cube(1, Cells::tetrahedra, 0.0);
  shared->use_ranks(all_ranks());
  shared->initialize(is_root ? first : none, chosen.degree);
  if (is_root) alone->initialize(first, chosen.degree);
  for (const VolumeMesh* mesh : {&first, &second}) {
    const auto result = shared->solve(is_root ? *mesh : none);
    if (is_root) expect_same_numbers(result, alone->solve(*mesh));
  }
}

class SolverOnRanksTest : public testing::TestWithParam<Case> {};

/// deal.II 9.4 does not number dofs of mixed volume meshes.
std::vector<Case> cases_of_deal_ii() {
  auto cases = volume_cases();
  std::erase_if(cases, [](const Case& c) { return c.cells == Cells::mixed_volume; });
  cases.push_back({Cells::hexahedra, 3});
  return cases;
}
INSTANTIATE_TEST_SUITE_P(Elements, SolverOnRanksTest, testing::ValuesIn(cases_of_deal_ii()),
                         [](const auto& info) { return name_of(info.param); });

TEST_P(SolverOnRanksTest, PoissonByDealIIEqualsThatOfOneProcess) {
  const auto [cells, degree] = GetParam();
  expect_same_on_all_ranks({"deal.II", degree, {{"cg_tolerance", "1e-13"}}},
                           unit_cube(4, cells, 0.0), unit_cube(4, cells, 0.2));
}

TEST_P(SolverOnRanksTest, ElasticityOfAKnownDisplacementEqualsThatOfOneProcess) {
  const auto [cells, degree] = GetParam();
  if (degree > 2) GTEST_SKIP() << "takes long";
  const bool has_tractions = cells != Cells::pyramids && cells != Cells::prisms;
  expect_same_on_all_ranks({"elasticity",
                            degree,
                            {{"u", "sin(x)*y ; cos(y)*z ; x*z"},
                             {"natural", has_tractions ? "right, side" : ""},
                             {"cg_tolerance", "1e-13"}}},
                           with_groups(unit_cube(3, cells, 0.0)),
                           with_groups(unit_cube(3, cells, 0.2)));
}

TEST_P(SolverOnRanksTest, ElasticityOfPartsUnderLoadEqualsThatOfOneProcess) {
  const auto [cells, degree] = GetParam();
  if (degree > 1) GTEST_SKIP() << "as the known displacement";
  Keyed keyed{{"E group", "right", "5"},
              {"nu group", "left", "0.4"},
              {"displacement group", "left", "0 ; 0 ; 0.1*y"},
              {"displacement group", "side", "free ; free ; 0.01*x"}};
  if (cells != Cells::pyramids && cells != Cells::prisms)
    keyed.push_back({"traction group", "right", "0.1 ; free ; y"});
  expect_same_on_all_ranks(
      {"elasticity", degree, {{"f", "0 ; 0 ; -1"}, {"cg_tolerance", "1e-13"}}, keyed},
      two_materials<3>(4, cells, 0.0), two_materials<3>(4, cells, 0.2));
}

TEST(SolverOnRanks, RefusesOnAllRanks) {
  const auto initialize = [](const Chosen& chosen, const VolumeMesh& mesh) {
    const auto made = chosen.make();
    made->use_ranks(all_ranks());
    made->initialize(all_ranks().is_root() ? mesh : unit_cube(1, Cells::tetrahedra, 0.0),
                     chosen.degree);
  };
  const auto cube = with_groups(unit_cube(3, Cells::hexahedra, 0.0));
  const auto mixed = test::box_mesh(2, 2, 4, test::BoxCells::mixed);
  EXPECT_THROW(initialize({"deal.II", 5}, cube), InputError);
  EXPECT_THROW(initialize({"deal.II", 1}, mixed), InputError);
  const Chosen nowhere{"elasticity", 1, {}, {{"displacement group", "nowhere", "0 ; 0 ; 0"}}};
  EXPECT_THROW(initialize(nowhere, cube), InputError);
  const Chosen loose{"elasticity", 1, {{"u", "x ; y ; z"}, {"natural", "left, right, side"}}, {}};
  EXPECT_THROW(initialize(loose, cube), InputError);
  EXPECT_THROW(initialize(loose, with_groups(unit_cube(2, Cells::prisms, 0.0))), InputError);
}

TEST(SolverOnRanks, FewCellsAreEnoughForEachRank) {
  expect_same_on_all_ranks({"deal.II", 2}, unit_cube(1, Cells::hexahedra, 0.0),
                           unit_cube(1, Cells::hexahedra, 0.0));
}

TEST(SeveralRanks, NoRankHasAnEnergyWhereACellIsFolded) {
  // Positive at its corners, but not inside.
  const auto mesh = unit_cube(3, Cells::hexahedra, 0.0);
  auto coordinates = mesh.copied_coordinates();
  for (auto& x : coordinates)
    if ((x - Point<3>::Constant(1.0 / 3.0)).norm() < 1e-6) x = Point<3>::Constant(0.9);
  const auto& solution = manufactured_solution<3>("volume");
  const auto solver = make_energy_solver(on_root(mesh), 1, solution, {}, all_ranks());
  EXPECT_EQ(solver->solve(coordinates), std::numeric_limits<double>::infinity());
  EXPECT_LT(solver->solve(mesh.coordinates()), std::numeric_limits<double>::infinity());
}

TEST(SeveralRanks, FewDofsAreEnoughForEachRank) {
  // More ranks than useful: some have no free dof.
  const auto mesh = unit_cube(2, Cells::hexahedra, 0.0);
  const auto record = PoissonSolver<3>(on_root(mesh), PoissonOptions{}, all_ranks())
                          .solve(mesh.coordinates(), manufactured_solution<3>("quadratic"));
  EXPECT_EQ(record.n_free, 1U);
  EXPECT_NEAR(record.condition_number, 1.0, 1e-14);
  EXPECT_EQ(record.condition_method, "dense");
}

TEST(SeveralRanks, TimeLimitStopsAllRanksTogether) {
  const auto mesh = unit_cube(6, Cells::hexahedra, 0.2);
  PoissonOptions options;
  options.max_cg_seconds = 0.0;
  const auto record = PoissonSolver<3>(on_root(mesh), options, all_ranks())
                          .solve(mesh.coordinates(), manufactured_solution<3>("volume"));
  EXPECT_EQ(record.cg_iterations, 1U);
  EXPECT_THAT(record.status, HasSubstr("CG stopped at its limit of time"));
}

TEST(SeveralRanks, RefusesOnAllRanks) {
  const auto make = [](const VolumeMesh& mesh, int degree,
                       const std::vector<std::string>& natural = {}) {
    const PoissonOptions options{.degree = degree, .natural_groups = natural};
    const PoissonSolver<3> solver(on_root(mesh), options, all_ranks());
  };
  EXPECT_THAT([&] { make(unit_cube(1, Cells::tetrahedra, 0.0), 1); },
              ThrowsMessage<InputError>(HasSubstr("no unknown")));
  EXPECT_THAT([&] { make(unit_cube(1, Cells::prisms, 0.0), 1); },
              ThrowsMessage<InputError>(HasSubstr("no unknown")));
  EXPECT_THROW(make(test::box_mesh(2, 2, 2, test::BoxCells::pyramids), 2), InputError);
  EXPECT_THROW(make(test::box_mesh(2, 2, 4, test::BoxCells::mixed), 2), InputError);
  EXPECT_THROW(make(unit_cube(3, Cells::hexahedra, 0.0), 1, {"nowhere"}), InputError);
  EXPECT_THROW(make(with_groups(unit_cube(3, Cells::prisms, 0.0)), 1, {"1", "2", "3"}), InputError);
}

}  // namespace
}  // namespace smoothfem

int main(int argc, char** argv) {
  return smoothfem::test::run_on_all_ranks(argc, argv);
}
