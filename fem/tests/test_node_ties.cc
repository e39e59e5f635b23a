// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/constraints/node_ties.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fem/poisson_solver.h"
#include "fem/tests/unit_mesh.h"

namespace smoothfem {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using testing::ThrowsMessage;

TEST(NodeTies, JoinedOnesHaveMastersThatAreNotTied) {
  const NodeTies hanging{.nodes = {{5, {{4, 0.25}, {7, 0.75}}}}, .inner_facets = {{4, 5}}};
  const NodeTies periodic{.nodes = {{5, {{1, 1.0}}}, {7, {{2, 1.0}}}}, .inner_facets = {{2, 3}}};
  const NodeTies both = joined_ties(hanging, periodic);
  ASSERT_EQ(both.nodes.size(), 2U);
  EXPECT_EQ(both.nodes[0].node, 5U);
  EXPECT_THAT(both.nodes[0].masters, ElementsAre(Pair(2, 0.75), Pair(4, 0.25)));
  EXPECT_EQ(both.nodes[1].node, 7U);
  EXPECT_THAT(both.nodes[1].masters, ElementsAre(Pair(2, 1.0)));
  EXPECT_EQ(both.inner_facets.size(), 2U);
  NodeTies circle;
  circle.nodes = {{4, {{5, 1.0}}}};
  EXPECT_THAT([&] { (void)joined_ties(hanging, circle); },
              ThrowsMessage<InputError>(HasSubstr("tied to itself")));
}

class NodeTiesTest : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Elements, NodeTiesTest, testing::ValuesIn(all_cases()),
                         [](const auto& info) { return name_of(info.param); });

TEST_P(NodeTiesTest, PeriodicSolutionConvergesWithTheExpectedOrder) {
  std::vector<double> l2;
  for (const std::size_t refinement : {2UL, 4UL})
    GetParam().on_mesh(8 * refinement, 4 * refinement, 0.15, [&]<int dim>(const Mesh<dim>& mesh) {
      const auto solution = derived_solution<dim>("sin(2*pi*x + 1)*cos(y)", "", {});
      PoissonOptions options{.degree = GetParam().degree,
                             .load = Load::quadrature,
                             .cg_tolerance = 1e-12,
                             .condition_number = ConditionNumberMethod::none,
                             .jacobi_cg = Recorded::never};
      const NodeTies ties = periodic_in_x(mesh);
      options.ties = std::make_shared<const NodeTies>(ties);
      if (GetParam().degree > 1) {
        EXPECT_THAT([&] { PoissonSolver<dim>(&mesh, options); },
                    ThrowsMessage<InputError>(HasSubstr("use degree 1")));
        return;
      }
      const auto record = PoissonSolver<dim>(&mesh, options).solve(mesh.coordinates(), solution);
      EXPECT_EQ(record.status, "ok");
      std::size_t n_given = 0;
      for (const auto& p : mesh.coordinates()) {
        bool on_other_side = false;
        for (int d = 1; d < dim; ++d) on_other_side |= p[d] == 0.0 || p[d] == 1.0;
        n_given += on_other_side || p.x() == 1.0;
      }
      EXPECT_EQ(record.n_free, mesh.n_nodes() - n_given);
      l2.push_back(record.l2_error);
    });
  if (l2.empty()) return;
  EXPECT_NEAR(std::log2(l2[0] / l2[1]), 2.0, 0.3);
}

}  // namespace
}  // namespace smoothfem
