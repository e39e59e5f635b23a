// SPDX-License-Identifier: GPL-3.0-or-later
// Diffusivities and natural conditions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fem/poisson_solver.h"
#include "fem/tests/unit_mesh.h"

namespace smoothfem {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

template <int dim>
ManufacturedSolution<dim> formula(const std::string& u, const std::string& diffusivity = {}) {
  return derived_solution<dim>(u, diffusivity, {});
}

/// A user-defined problem for meshes of each dimension.
struct OwnProblem {
  std::string planar_u, planar_diffusivity, volume_u, volume_diffusivity;

  template <int dim>
  ManufacturedSolution<dim> solution() const {
    return dim == 2 ? formula<dim>(planar_u, planar_diffusivity)
                    : formula<dim>(volume_u, volume_diffusivity);
  }
};
const OwnProblem linear{"1 + 2*x - 3*y", "3, 1 ; 1, 2", "1 + 2*x - 3*y + z/2",
                        "3, 1, 0 ; 1, 2, 0.5 ; 0, 0.5, 1"};
const OwnProblem quadratic{"x^2 + x*y - 2*y^2 + y", "3, 1 ; 1, 2",
                           "x^2 + x*y - 2*y^2 + 3*z^2 - x*z", "3, 1, 0 ; 1, 2, 0.5 ; 0, 0.5, 1"};
const OwnProblem smooth{"sin(pi*x)*cos(y) + x*y", "2 + x, y/2 ; y/2, 1 + y^2",
                        "sin(pi*x)*cos(y) + x*y*z",
                        "2 + x, y/2, 0 ; y/2, 1 + y^2, 0 ; 0, 0, exp(z)"};

class OwnProblemTest : public testing::TestWithParam<Case> {
 protected:
  static PoissonOptions exact_options(const std::vector<std::string>& natural) {
    PoissonOptions options;
    options.degree = GetParam().degree;
    options.natural_groups = natural;
    options.cg_tolerance = 1e-14;
    options.condition_number = ConditionNumberMethod::none;
    options.jacobi_cg = Recorded::never;
    return options;
  }

  template <int dim>
  static SolutionRecord solve(const Mesh<dim>& mesh, const ManufacturedSolution<dim>& solution,
                              const std::vector<std::string>& natural, bool galerkin) {
    auto options = exact_options(natural);
    options.load = galerkin ? Load::quadrature : Load::nodal;
    return PoissonSolver<dim>(&mesh, options).solve(mesh.coordinates(), solution);
  }

  /// True errors in L2 and H1 on a mesh, one of half its size, and so on.
  static void expect_orders(const OwnProblem& problem, const std::vector<std::string>& natural) {
    const int degree = GetParam().degree;
    std::vector<double> l2, h1;
    for (const std::size_t refinement : {1UL, 2UL})
      GetParam().on_mesh(8 * refinement, 4 * refinement, 0.15, [&]<int dim>(const Mesh<dim>& mesh) {
        const auto record = solve(with_groups(mesh), problem.solution<dim>(), natural, true);
        l2.push_back(record.l2_error);
        h1.push_back(record.h1_error);
      });
    EXPECT_NEAR(std::log2(l2[0] / l2[1]), degree + 1, 0.3);
    EXPECT_NEAR(std::log2(h1[0] / h1[1]), degree, 0.2);
  }
};

INSTANTIATE_TEST_SUITE_P(Elements, OwnProblemTest, testing::ValuesIn(all_cases()),
                         [](const auto& info) { return name_of(info.param); });

TEST_P(OwnProblemTest, SolutionInTheSpaceIsFoundUpToRoundOff) {
  const auto& problem = GetParam().degree == 1 ? linear : quadratic;
  for (const bool galerkin : {false, true})
    for (const std::vector<std::string>& natural :
         {std::vector<std::string>{}, {"right"}, {"2", "side"}})
      GetParam().on_mesh(6, 5, 0.25, [&]<int dim>(const Mesh<dim>& mesh) {
        const auto record = solve(with_groups(mesh), problem.solution<dim>(), natural, galerkin);
        EXPECT_EQ(record.status, "ok");
        EXPECT_LT(record.e_max, 1e-10);
        EXPECT_LT(record.e_h1, 1e-10);
        EXPECT_LT(record.l2_error, 1e-10);
        EXPECT_LT(record.h1_error, 1e-10);
      });
}

TEST_P(OwnProblemTest, ErrorsFallWithTheExpectedOrders) {
  expect_orders(smooth, {});
  expect_orders(smooth, {"right", "side"});
}

/// A mesh stretched by 2 in x, with u(x/2, y) and the tensor diag(4, 1), corresponds to the problem
/// of the identity on the original mesh. That problem's matrix is half as large.
TEST_P(OwnProblemTest, TensorOnAStretchedMeshIsTheIdentityOnTheMesh) {
  GetParam().on_mesh(6, 4, 0.2, [&]<int dim>(const Mesh<dim>& mesh) {
    Mesh<dim> stretched = mesh;
    for (auto& p : stretched.coordinates()) p.x() *= 2.0;
    const auto plain = formula<dim>(dim == 2 ? "sin(3*x)*y^2" : "sin(3*x)*y^2 + z^3");
    const auto tensor = formula<dim>(dim == 2 ? "sin(3*x/2)*y^2" : "sin(3*x/2)*y^2 + z^3",
                                     dim == 2 ? "4, 0 ; 0, 1" : "4, 0, 0 ; 0, 1, 0 ; 0, 0, 1");
    auto options = exact_options({});
    options.condition_number = ConditionNumberMethod::verified;
    options.tensor_points.hexahedron = 6;  // the same for both
    PoissonSolver<dim> one(&mesh, options), other(&stretched, options);
    const auto expected = one.solve(mesh.coordinates(), plain);
    const auto record = other.solve(stretched.coordinates(), tensor);
    EXPECT_NEAR(record.lambda_max / expected.lambda_max, 2.0, 1e-9);
    EXPECT_NEAR(record.condition_number / expected.condition_number, 1.0, 1e-9);
    EXPECT_NEAR(record.e_max / expected.e_max, 1.0, 1e-8);
    EXPECT_NEAR(record.e_l2 / expected.e_l2, std::sqrt(2.0), 1e-8);
  });
}

TEST_P(OwnProblemTest, ScalarOneHasTheMatrixOfTheIdentity) {
  GetParam().on_mesh(5, 4, 0.2, [&]<int dim>(const Mesh<dim>& mesh) {
    const std::string u = "sin(x)*y";
    const auto identity = solve(mesh, formula<dim>(u), {}, false);
    const auto one = solve(mesh, formula<dim>(u, "1"), {}, false);
    EXPECT_NEAR(one.e_max / identity.e_max, 1.0, 1e-4);
    EXPECT_NEAR(one.l2_error / identity.l2_error, 1.0, 1e-4);
  });
}

TEST_P(OwnProblemTest, DofsWithNaturalConditionsAreFree) {
  GetParam().on_mesh(5, 4, 0.1, [&]<int dim>(const Mesh<dim>& plain) {
    const auto mesh = with_groups(plain);
    const auto n_fixed = [&](const std::vector<std::string>& natural) {
      const auto record = solve(mesh, manufactured_solution<dim>("linear"), natural, false);
      return record.n_dofs - record.n_free;
    };
    // The remaining boundary is a side of the square or cube, with its own boundary.
    const auto n_on_left = [&] {
      const auto space = make_finite_element_space(&mesh, GetParam().degree, TensorPoints{});
      const auto points = space->dof_points(mesh.copied_coordinates());
      return static_cast<std::size_t>(std::count_if(
          points.begin(), points.end(), [](const auto& p) { return std::abs(p.x()) < 1e-12; }));
    };
    EXPECT_EQ(n_fixed({"right", "side"}), n_on_left());
    EXPECT_EQ(n_fixed({"side", "2"}), n_on_left());
  });
}

TEST(OwnProblem, NaturalGroupsAreThoseOfTheMesh) {
  const auto mesh = with_groups(unit_square(3, Cells::mixed, 0.1));
  const auto make = [&](const std::vector<std::string>& groups) {
    PoissonOptions options;
    options.natural_groups = groups;
    PoissonSolver<2>(&mesh, options);
  };
  EXPECT_NO_THROW(make({"left", "2"}));
  EXPECT_THAT([&] { make({"rigth"}); },
              ThrowsMessage<InputError>(HasSubstr(
                  "no boundary group is called 'rigth'; the mesh has the groups 1 (left), "
                  "2 (right), 3 (side)")));
  EXPECT_THAT(
      [&] {
        make({"left", "right", "side"});
      },
      ThrowsMessage<InputError>(HasSubstr("remove a group from 'natural'")));
  const auto plain = unit_square(3, Cells::mixed, 0.1);
  EXPECT_THAT([&] { PoissonSolver<2>(&plain, {.natural_groups = {"left"}}); },
              ThrowsMessage<InputError>(HasSubstr("the mesh has no labelled boundary groups")));
}

TEST(OwnProblem, GroupsInsideAMeshHaveNoNaturalConditions) {
  auto mesh = unit_square(3, Cells::quadrilaterals, 0.1);
  MeshLabels labels;
  labels.facets.append(std::vector<NodeIndex>{5, 6});
  labels.facet_tags = {7};
  const PlanarMesh labelled(
      std::make_shared<const Topology>(2, mesh.n_nodes(), mesh.topology().cells(), std::nullopt,
                                       std::move(labels)),
      mesh.copied_coordinates());
  EXPECT_THAT([&] { PoissonSolver<2>(&labelled, {.natural_groups = {"7"}}); },
              ThrowsMessage<InputError>(HasSubstr("but no facet on the boundary")));
}

}  // namespace
}  // namespace smoothfem
