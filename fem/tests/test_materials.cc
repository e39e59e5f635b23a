// SPDX-License-Identifier: GPL-3.0-or-later
// Diffusivities of groups of cells.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/materials/materials_of_mesh.h"
#include "fem/poisson_solver.h"
#include "fem/tests/unit_mesh.h"

namespace smoothfem {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class MaterialsTest : public testing::TestWithParam<Case> {
 protected:
  template <int dim>
  static Mesh<dim> mesh(double amount = 0.2) {
    return two_materials<dim>(dim == 2 ? 6 : 4, GetParam().cells, amount);
  }

  template <int dim>
  static SolutionRecord solve(const Mesh<dim>& mesh, const ManufacturedSolution<dim>& solution,
                              bool galerkin, const std::vector<std::string>& natural = {}) {
    PoissonOptions options;
    options.degree = GetParam().degree;
    options.load = galerkin ? Load::quadrature : Load::nodal;
    options.natural_groups = natural;
    options.cg_tolerance = 1e-14;
    options.condition_number = ConditionNumberMethod::none;
    options.jacobi_cg = Recorded::never;
    return PoissonSolver<dim>(&mesh, options).solve(mesh.coordinates(), solution);
  }

  template <class Check>
  static void for_dimension(const Check& check) {
    with_dimension(dimension_of(GetParam().cells), check);
  }
};

INSTANTIATE_TEST_SUITE_P(Elements, MaterialsTest, testing::ValuesIn(all_cases()),
                         [](const auto& info) { return name_of(info.param); });

TEST_P(MaterialsTest, SolutionInTheSpaceIsFoundUpToRoundOff) {
  for_dimension([]<int dim>() {
    const std::string name =
        GetParam().degree == 1 ? "interface-plane" : "interface-plane-quadratic";
    const auto fitted = mesh<dim>();
    const auto solution = with_materials_of(manufactured_solution<dim>(name), fitted);
    for (const bool galerkin : {false, true}) {
      const auto record = solve(fitted, solution, galerkin);
      EXPECT_LT(record.e_max, 1e-10);
      EXPECT_LT(record.h1_error, 1e-9);
    }
  });
}

TEST_P(MaterialsTest, FormulasOfGroupsGiveWhatThePositionGives) {
  for_dimension([]<int dim>() {
    const auto fitted = mesh<dim>();
    const std::string u = "if(x < 0.5, x - 0.5, (x - 0.5)/10) + y^2";
    const auto by_tag =
        with_materials_of(manufactured_solution<dim>("interface-plane-quadratic"), fitted);
    const auto by_group = with_materials_of(
        derived_solution<dim>(dim == 2 ? u : u + " + z^2", "1", {}, {{"right", "10"}}), fitted);
    const auto by_number =
        with_materials_of(derived_solution<dim>(dim == 2 ? u : u + " + z^2", "7", {},
                                                {{"2", "10"}, {"1", "cos(y)^2 + sin(y)^2"}}),
                          fitted);
    for (const bool galerkin : {false, true}) {
      const auto expected = solve(fitted, by_tag, galerkin, {"right", "side"});
      for (const auto& solution : {by_group, by_number}) {
        const auto record = solve(fitted, solution, galerkin, {"right", "side"});
        EXPECT_NEAR(record.e_max, expected.e_max, 1e-6 * expected.e_max + 1e-9);
        EXPECT_NEAR(record.h1_error, expected.h1_error, 1e-6 * expected.h1_error + 1e-9);
      }
    }
  });
}

TEST_P(MaterialsTest, MovedInterfaceCostsError) {
  for_dimension([]<int dim>() {
    const auto fitted = mesh<dim>();
    const auto solution = with_materials_of(manufactured_solution<dim>("interface-plane"), fitted);
    Mesh<dim> moved = fitted;
    for (auto& p : moved.coordinates())
      if (p.x() == 0.5 && (p.array() > 0.1).all() && (p.array() < 0.9).all()) p.x() -= 0.05;
    EXPECT_GT(solve(moved, solution, false).l2_error, 1e-3);
  });
}

TEST(Materials, AreRefusedIfTheyDoNotFitTheMesh) {
  const auto mesh = two_materials<2>(4, Cells::triangles, 0.0);
  const auto refused = [&](const std::string& u, const std::vector<GroupDiffusivity>& groups) {
    return [=] { (void)with_materials_of(derived_solution<2>(u, "", {}, groups), mesh); };
  };
  EXPECT_THAT(refused("x", {{"rigth", "1"}}),
              ThrowsMessage<InputError>(AllOf(HasSubstr("group 'rigth'"), HasSubstr("'right'"))));
  EXPECT_THAT(refused("y", {{"right", "2"}, {"2", "3"}}),
              ThrowsMessage<InputError>(HasSubstr("are in both")));
  EXPECT_THAT(refused("x", {{"right", "2"}}),
              ThrowsMessage<InputError>(AllOf(HasSubstr("normal flux"), HasSubstr("(0.5"))));
  EXPECT_THAT(refused("if(x < 0.5, 0, y)", {{"right", "2"}}),
              ThrowsMessage<InputError>(HasSubstr("'u' jumps")));
  EXPECT_THAT(refused("y", {{"right", "x - 0.7"}}),
              ThrowsMessage<InputError>(HasSubstr("not positive definite")));
  EXPECT_NO_THROW(refused("y", {{"right", "2"}})());
}

TEST(Materials, ByTagNeedGroupsOnOneSideEach) {
  const auto plain = unit_square(4, Cells::triangles, 0.0);
  EXPECT_THAT([&] { (void)with_materials_of(manufactured_solution<2>("interface-plane"), plain); },
              ThrowsMessage<InputError>(HasSubstr("both sides of its interface")));
}

}  // namespace
}  // namespace smoothfem
