// SPDX-License-Identifier: GPL-3.0-or-later
// Solvers by deal.II: Poisson's equation against the fast path, others against known solutions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "fem/poisson_solver.h"
#include "fem/tests/configured_solver.h"
#include "fem/tests/unit_mesh.h"

namespace smoothfem {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::map<std::string, double> numbers_of(const SolverResult& result) {
  std::map<std::string, double> numbers;
  for (const auto& [name, value] : result.numbers)
    EXPECT_TRUE(numbers.emplace(name, value).second) << name << " twice";
  return numbers;
}

template <int dim>
std::map<std::string, double> solve(const Mesh<dim>& mesh, int degree, const std::string& type,
                                    const Settings& settings, const Keyed& keyed = {}) {
  const auto made = configured_solver<dim>(type, settings, keyed);
  made->initialize(mesh, degree);
  const SolverResult result = made->solve(mesh);
  EXPECT_EQ(result.status, "ok");
  const auto numbers = numbers_of(result);
  for (const auto& described : made->numbers())
    EXPECT_TRUE(numbers.contains(described.name)) << described.name;
  return numbers;
}

class SolverOfCells : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Elements, SolverOfCells, testing::ValuesIn(cases_of_deal_ii()),
                         [](const auto& info) { return name_of(info.param); });

TEST_P(SolverOfCells, DealIIHasTheNumbersOfTheFastPath) {
  GetParam().on_mesh(5, 3, 0.2, [&]<int dim>(const Mesh<dim>& mesh) {
    const auto solution = derived_solution<dim>("sin(2*x)*exp(y)", "2 + x*y", {});
    PoissonOptions options;
    options.degree = GetParam().degree;
    options.cg_tolerance = 1e-13;
    options.tensor_points = {6, 6};
    const SolutionRecord fast =
        PoissonSolver<dim>(&mesh, options).solve(mesh.coordinates(), solution);

    const auto made =
        configured_solver<dim>("deal.II", {{"cg_tolerance", "1e-13"}, {"points", "6"}});
    made->use_solution(solution);
    made->initialize(mesh, options.degree);
    const auto other = numbers_of(made->solve(mesh));
    EXPECT_NEAR(other.at("h1_error"), fast.h1_error, 1e-10 * fast.h1_error);
    EXPECT_NEAR(other.at("l2_error"), fast.l2_error, 1e-10 * fast.l2_error);
    EXPECT_NEAR(other.at("condition_number"), fast.condition_number, 1e-6 * fast.condition_number);
    EXPECT_EQ(other.at("n_free"), static_cast<double>(fast.n_free));
    EXPECT_NEAR(other.at("cg_iterations"), static_cast<double>(fast.cg_iterations), 2.0);
  });
}

TEST_P(SolverOfCells, LinearDisplacementsAreExact) {
  GetParam().on_mesh(4, 2, 0.2, [&]<int dim>(const Mesh<dim>& mesh) {
    for (const std::string nu : {"0.3", "0.499", "-0.3"}) {
      const auto numbers =
          solve(mesh, GetParam().degree, "elasticity",
                {{"u", dim == 2 ? "x + 2*y ; 3*x - y" : "x + 2*y ; 3*x - y + z ; x - z"},
                 {"nu", nu},
                 {"cg_tolerance", "1e-13"}});
      EXPECT_LT(numbers.at("h1_error"), 1e-9) << nu;
      EXPECT_LT(numbers.at("energy_error"), 1e-8) << nu;
      EXPECT_LT(numbers.at("von_mises_error"), 1e-7) << nu;
    }
  });
}

/// Cells whose facets are of one type. On others the solver has no tractions.
class SolverOfFacets : public SolverOfCells {};
std::vector<Case> cases_of_facets() {
  auto cases = cases_of_deal_ii();
  std::erase_if(cases, [](const Case& c) { return c.cells >= Cells::pyramids; });
  return cases;
}
INSTANTIATE_TEST_SUITE_P(Elements, SolverOfFacets, testing::ValuesIn(cases_of_facets()),
                         [](const auto& info) { return name_of(info.param); });

TEST_P(SolverOfFacets, TractionsOfALinearDisplacementAreExact) {
  GetParam().on_mesh(4, 2, 0.2, [&]<int dim>(const Mesh<dim>& mesh) {
    const auto numbers = solve(with_groups(mesh), GetParam().degree, "elasticity",
                               {{"u", dim == 2 ? "x + 2*y ; 3*x - y" : "x + 2*y ; 3*x - y ; x - z"},
                                {"natural", "right, side"},
                                {"cg_tolerance", "1e-13"}});
    EXPECT_LT(numbers.at("h1_error"), 1e-9);
  });
}

/// A bar of length 1, held at its left end and pulled at its right end, without transverse
/// contraction: u_x = x t / E.
TEST_P(SolverOfFacets, ABarUnderTractionIsStretched) {
  GetParam().on_mesh(4, 2, 0.2, [&]<int dim>(const Mesh<dim>& mesh) {
    const std::string zero = dim == 2 ? "0 ; 0" : "0 ; 0 ; 0";
    const auto numbers = solve(with_groups(mesh), GetParam().degree, "elasticity",
                               {{"E", "10"}, {"nu", "0"}, {"cg_tolerance", "1e-13"}},
                               {{"displacement group", "left", zero},
                                {"traction group", "2", dim == 2 ? "3 ; free" : "3 ; free ; 0"}});
    EXPECT_NEAR(numbers.at("u_max"), 0.3, 1e-10);
    EXPECT_NEAR(numbers.at("von_mises_max"), 3.0, 1e-8);
    EXPECT_NEAR(numbers.at("energy"), 3.0 * 0.3, 1e-9);
  });
}

TEST(Elasticity, HasMaterialsOfGroups) {
  const auto check = [&]<int dim>(const Mesh<dim>& mesh) {
    const auto numbers = solve(mesh, 1, "elasticity", {{"nu", "0"}, {"cg_tolerance", "1e-13"}},
                               {{"E group", "left", "2"},
                                {"E group", "2", "4"},
                                {"displacement group", "left", dim == 2 ? "0 ; 0" : "0 ; 0 ; 0"},
                                {"traction group", "right", dim == 2 ? "3 ; 0" : "3 ; 0 ; 0"}});
    EXPECT_NEAR(numbers.at("u_max"), 3.0 * (0.5 / 2.0 + 0.5 / 4.0), 1e-10);
  };
  check(two_materials<2>(4, Cells::quadrilaterals, 0.2));
  check(two_materials<3>(2, Cells::tetrahedra, 0.2));
}

TEST(Elasticity, PlaneStressIsThatOfAThinPlate) {
  // Pulled in x, a thin plate has eps_y = -nu sigma / E; here u_y is free, so eps_y follows.
  const auto mesh = with_groups(unit_square(4, Cells::quadrilaterals, 0.2));
  const Settings settings{{"u", "x/10 ; -0.3*y/10"},
                          {"E", "10"},
                          {"nu", "0.3"},
                          {"plane", "stress"},
                          {"natural", "right, side"},
                          {"cg_tolerance", "1e-13"}};
  const auto numbers = solve<2>(mesh, 1, "elasticity", settings);
  EXPECT_NEAR(numbers.at("von_mises_max"), 1.0, 1e-9);  // sigma_x = 1, all others 0
  EXPECT_NEAR(numbers.at("energy"), 0.1, 1e-10);
}

/// Observed orders of the errors on meshes of n and 2 n cells in each direction.
template <int dim>
void expect_orders(Cells cells, int degree, std::size_t n) {
  std::array<std::map<std::string, double>, 2> of_size;
  for (std::size_t k = 0; k < 2; ++k)
    of_size[k] = solve(unit_mesh<dim>((k + 1) * n, cells, 0.1), degree, "elasticity",
                       {{"u", dim == 2 ? "sin(2*x + y) ; exp(x)*cos(y)"
                                       : "sin(2*x + y) ; exp(x)*cos(z) ; x*sin(y - z)"},
                        {"cg_tolerance", "1e-12"}});
  const auto order = [&](const std::string& error) {
    return std::log2(of_size[0].at(error) / of_size[1].at(error));
  };
  const std::string what = std::string(name_of(cells)) + " of degree " + std::to_string(degree);
  EXPECT_NEAR(order("h1_error"), degree, 0.25) << what;
  EXPECT_NEAR(order("energy_error"), degree, 0.25) << what;
  EXPECT_NEAR(order("l2_error"), degree + 1, 0.35) << what;
}

TEST(Elasticity, HasTheOrdersOfItsDegree) {
  for (const int degree : {1, 2}) expect_orders<2>(Cells::triangles, degree, 4);
  for (const int degree : {1, 2, 3, 4}) expect_orders<2>(Cells::quadrilaterals, degree, 4);
  for (const int degree : {1, 2}) expect_orders<3>(Cells::tetrahedra, degree, 2);
  for (const int degree : {1, 2}) expect_orders<3>(Cells::hexahedra, degree, 2);
}

TEST(Elasticity, RigidBodyModesMakeMultigridGood) {
  const auto mesh = unit_square(24, Cells::quadrilaterals, 0.2);
  const auto numbers = solve<2>(mesh, 1, "elasticity", {{"u", "sin(x) ; y"}});
  EXPECT_LT(numbers.at("amg_cg_iterations"), 0.25 * numbers.at("jacobi_cg_iterations"));
}

TEST(Elasticity, TheWholeBoundaryCanBeHeld) {
  const auto mesh = unit_square(6, Cells::quadrilaterals, 0.1);
  const Settings load{{"f", "1 ; x"}, {"cg_tolerance", "1e-12"}};
  const auto plain =
      solve<2>(mesh, 1, "elasticity", load, {{"displacement group", "boundary", "0 ; 0"}});
  const auto grouped = solve<2>(with_groups(mesh), 1, "elasticity", load,
                                {{"displacement group", "boundary", "0 ; 0"}});
  EXPECT_EQ(plain.at("n_free"), 50.0) << "two components at 5 x 5 inner nodes";
  EXPECT_NEAR(plain.at("energy"), grouped.at("energy"), 1e-12);
}

TEST(Elasticity, RefusesWhatItCannotSolve) {
  const auto refused = [](const Settings& settings, const Keyed& keyed, const std::string& why) {
    EXPECT_THAT(
        [&] {
          (void)solve<2>(with_groups(unit_square(2, Cells::triangles, 0.0)), 1, "elasticity",
                         settings, keyed);
        },
        ThrowsMessage<InputError>(HasSubstr(why)));
  };
  refused({}, {}, "needs a displacement u, or a group of the boundary that is held");
  refused({{"u", "x"}}, {}, "'u', 'x', needs 2 formulas");
  refused({{"u", "x ; q"}}, {}, "'q'");
  refused({{"u", "x ; y"}, {"nu", "0.5"}}, {}, "nu = 0.5 is outside its range (-1, 0.5)");
  refused({{"u", "x ; y"}}, {{"E group", "steel", "2"}}, "no cell of the mesh is in this group");
  refused({{"u", "x ; y"}}, {{"E group", "steel", "-2"}}, "E group steel = -2 is outside");
  refused({{"u", "x ; y"}, {"natural", "top"}}, {}, "names the group 'top' of the boundary");
  refused({{"u", "x ; y"}, {"natural", "left, right, side"}}, {},
          "no part of the boundary is held");
  refused({{"u", "x ; y"}}, {{"traction group", "left", "1 ; 0"}}, "leave out u, or 'f'");
  refused({}, {{"displacement group", "bottom", "0 ; 0"}},
          "does not have; the mesh has the groups");
  refused({}, {{"displacement group", "left", "free ; free"}}, "no part of the boundary is held");
}

TEST_P(SolverOfCells, TiedNodesHaveTheNumbersOfTheFastPath) {
  GetParam().on_mesh(6, 3, 0.2, [&]<int dim>(const Mesh<dim>& mesh) {
    const auto ties = std::make_shared<const NodeTies>(periodic_in_x(mesh));
    const auto solution = derived_solution<dim>("sin(2*pi*x + 1)*cos(y)", "", {});
    const auto made =
        configured_solver<dim>("deal.II", {{"cg_tolerance", "1e-13"}, {"points", "5"}});
    made->use_solution(solution);
    made->use_ties(ties);
    if (GetParam().degree > 1) {
      EXPECT_THAT([&] { made->initialize(mesh, GetParam().degree); },
                  ThrowsMessage<InputError>(HasSubstr("need finite elements of degree 1")));
      return;
    }
    PoissonOptions options;
    options.cg_tolerance = 1e-13;
    options.tensor_points = {5, 5};
    options.ties = ties;
    const SolutionRecord fast =
        PoissonSolver<dim>(&mesh, options).solve(mesh.coordinates(), solution);
    made->initialize(mesh, 1);
    const auto other = numbers_of(made->solve(mesh));
    EXPECT_EQ(other.at("n_free"), static_cast<double>(fast.n_free));
    EXPECT_NEAR(other.at("h1_error"), fast.h1_error, 1e-10 * fast.h1_error);
    EXPECT_NEAR(other.at("condition_number"), fast.condition_number, 1e-6 * fast.condition_number);
  });
}

/// Returns the numbers of convection-diffusion with a known u.
std::map<std::string, double> convected(const Mesh<2>& mesh, int degree, const std::string& u,
                                        const Settings& settings) {
  const auto made = configured_solver<2>("convection-diffusion", settings);
  made->use_solution(derived_solution<2>(u, "", {}));
  made->initialize(mesh, degree);
  return numbers_of(made->solve(mesh));
}

TEST(ConvectionDiffusion, HasTheOrdersOfItsDegree) {
  for (const std::string stabilization : {"supg", "none"})
    for (const Cells cells : {Cells::triangles, Cells::quadrilaterals})
      for (const int degree : {1, 2}) {
        std::array<std::map<std::string, double>, 2> of_size;
        for (std::size_t k = 0; k < 2; ++k)
          of_size[k] = convected(
              unit_square((k + 1) * 8, cells, 0.1), degree, "sin(2*x + y)",
              {{"diffusion", "0.05"}, {"velocity", "1 + y ; x"}, {"stabilization", stabilization}});
        const auto order = [&](const std::string& error) {
          return std::log2(of_size[0].at(error) / of_size[1].at(error));
        };
        EXPECT_NEAR(order("h1_error"), degree, 0.2) << stabilization << name_of(cells);
        EXPECT_NEAR(order("l2_error"), degree + 1, 0.35) << stabilization << name_of(cells);
      }
}

// In one dimension, linear elements with this stabilization have the exact values at the nodes.
TEST(ConvectionDiffusion, SupgInterpolatesABoundaryLayer) {
  constexpr int n = 8;
  constexpr double eps = 0.1;
  const auto exact = [](double x) { return std::expm1(x / eps) / std::expm1(1.0 / eps); };
  double squares = 0.0;
  constexpr int steps = 4000;  // of the midpoint rule
  for (int k = 0; k < steps; ++k) {
    const double x = (k + 0.5) / steps, cell = std::floor(x * n);
    const double between = std::lerp(exact(cell / n), exact((cell + 1.0) / n), x * n - cell);
    squares += (exact(x) - between) * (exact(x) - between) / steps;
  }
  const auto mesh = unit_square(n, Cells::quadrilaterals, 0.0);
  const std::string u = "(exp(10*x) - 1)/(exp(10) - 1)";
  const Settings settings{{"diffusion", "0.1"}, {"velocity", "1 ; 0"}, {"points", "8"}};
  const auto numbers = convected(mesh, 1, u, settings);
  EXPECT_NEAR(numbers.at("l2_error"), std::sqrt(squares), 1e-5 * std::sqrt(squares));
  EXPECT_NEAR(numbers.at("peclet_max"), 1.0 / (2.0 * n * eps), 1e-12);
  EXPECT_LT(numbers.at("overshoot"), 1e-12);

  Settings galerkin{{"diffusion", "0.01"}, {"velocity", "1 ; 0"}, {"stabilization", "none"}};
  const std::string steep = "(exp(100*x) - 1)/(exp(100) - 1)";
  EXPECT_GT(convected(mesh, 1, steep, galerkin).at("overshoot"), 0.1);
  galerkin["stabilization"] = "supg";
  EXPECT_LT(convected(mesh, 1, steep, galerkin).at("overshoot"), 1e-9);
}

TEST(ConvectionDiffusion, RefusesWhatItCannotSolve) {
  const auto mesh = unit_square(2, Cells::triangles, 0.0);
  EXPECT_THAT([&] { (void)convected(mesh, 1, "x", {}); },
              ThrowsMessage<InputError>(HasSubstr("needs a velocity, such as")));
  EXPECT_THAT(
      [&] {
        (void)convected(mesh, 1, "x", {{"velocity", "1"}});
      },
      ThrowsMessage<InputError>(HasSubstr("'velocity', '1', needs 2 formulas")));
}

TEST(DealII, RefusesDegreesThatItDoesNotHave) {
  const auto refused = []<int dim>(const Mesh<dim>& mesh, int degree,
                                   const std::string& why = "no finite elements of degree") {
    EXPECT_THAT(
        [&] {
          (void)solve<dim>(mesh, degree, "elasticity", {{"u", dim == 2 ? "x ; y" : "x ; y ; z"}});
        },
        ThrowsMessage<InputError>(HasSubstr(why)));
  };
  refused(unit_square(2, Cells::triangles, 0.0), 3);
  refused(unit_square(2, Cells::mixed, 0.0), 3);
  refused(unit_cube(1, Cells::prisms, 0.0), 2);
  refused(unit_cube(3, Cells::mixed_volume, 0.0), 1, "several types of cells");
}

TEST(Solvers, UnknownTypesAreRefusedWithThoseThatExist) {
  EXPECT_THAT([] { (void)make_solver<2>("elastic"); },
              ThrowsMessage<InputError>(HasSubstr("elasticity")));
}

}  // namespace
}  // namespace smoothfem
