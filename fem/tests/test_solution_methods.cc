// SPDX-License-Identifier: GPL-3.0-or-later
/// Requirements for every solution-adaptive method: the conformance tests that apply to them.
/// Similarities and regular patches are left out, as the problem is fixed in space.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/adaptivity/poisson_problem.h"
#include "fem/poisson_solver.h"
#include "fem/tests/unit_mesh.h"
#include "smoothing/base/parallel.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/tests/methods.h"

namespace smoothfem {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const auto& info : method_catalogue(true))
    if (info.needs_problem()) all.push_back(info.name);
  return all;
}

template <int dim>
std::vector<Mesh<dim>> distorted_meshes() {
  if constexpr (dim == 2)
    return {unit_square(10, Cells::triangles, 0.3), unit_square(10, Cells::quadrilaterals, 0.3),
            unit_square(10, Cells::mixed, 0.3)};
  else
    return {unit_cube(5, Cells::tetrahedra, 0.3), unit_cube(5, Cells::hexahedra, 0.3)};
}

/// A solution with a layer that GETMe's mesh does not resolve.
template <int dim>
ManufacturedSolution<dim> layer() {
  return derived_solution<dim>("exp(-10*x)*cos(y) + x*y", {}, {});
}

class EveryMethodWithAProblem : public testing::TestWithParam<std::string> {
 protected:
  template <class Check>
  static void in_every_dimension(const Check& check) {
    check.template operator()<2>();
    check.template operator()<3>();
  }
  template <int dim>
  static Method<dim> method() {
    auto made = make_method<dim>(GetParam());
    made.problem = make_poisson_problem<dim>(layer<dim>());
    return made;
  }
};

TEST_P(EveryMethodWithAProblem, LowersTheTrueErrorBelowThatOfItsStart) {
  in_every_dimension([]<int dim>() {
    for (const auto& mesh : distorted_meshes<dim>()) {
      PoissonSolver<dim> solver(&mesh, {.load = Load::quadrature,
                                        .condition_number = ConditionNumberMethod::none,
                                        .jacobi_cg = Recorded::never});
      const auto error_of = [&](const Mesh<dim>& m) {
        return solver.solve(m.coordinates(), layer<dim>()).h1_error;
      };
      Mesh<dim> started = mesh, result = mesh;
      auto getme = make_method<dim>("getme");
      smooth(started, getme);
      auto made = method<dim>();
      smooth(result, made);
      EXPECT_LT(error_of(result), 0.98 * error_of(started)) << mesh.topology().cell_nodes(0).size();
    }
  });
}

/// Two solutions with a layer along each axis, the second one much larger, in a varying medium.
TEST_P(EveryMethodWithAProblem, LowersTheErrorOfEachSolution) {
  in_every_dimension([]<int dim>() {
    const std::vector<ManufacturedSolution<dim>> solutions{
        layer<dim>(), derived_solution<dim>("300*exp(-10*y)*cos(x)", "1 + x + y", {})};
    for (const auto& mesh : distorted_meshes<dim>()) {
      Mesh<dim> started = mesh, result = mesh;
      auto getme = make_method<dim>("getme");
      smooth(started, getme);
      auto made = method<dim>();
      made.problem = make_poisson_problem<dim>(solutions);
      for (const auto& parameter : made.parameters())
        if (parameter.name.ends_with(".solves")) made.set(parameter.name, "20");
      smooth(result, made);
      PoissonSolver<dim> solver(&mesh, {.load = Load::quadrature,
                                        .condition_number = ConditionNumberMethod::none,
                                        .jacobi_cg = Recorded::never});
      for (const auto& solution : solutions)
        EXPECT_LT(solver.solve(result.coordinates(), solution).h1_error,
                  0.99 * solver.solve(started.coordinates(), solution).h1_error)
            << solution.formula << ", " << mesh.topology().cell_nodes(0).size();
    }
  });
}

TEST_P(EveryMethodWithAProblem, MovesFreeNodesOnlyAndKeepsCellsValid) {
  in_every_dimension([]<int dim>() {
    for (const auto& mesh : distorted_meshes<dim>()) {
      Mesh<dim> result = mesh;
      auto made = method<dim>();
      smooth(result, made, [&](const IterationRecord& record, const auto& seen) {
        EXPECT_EQ(mesh_quality(seen).n_invalid, 0u) << record.record;
        EXPECT_EQ(mesh_quality(seen).q_mean, record.quality.q_mean) << record.record;
      });
      EXPECT_EQ(test::n_moved_fixed_nodes(mesh, result), 0u);
    }
  });
}

TEST_P(EveryMethodWithAProblem, ReportsItsSolvesAndKeepsItsBudget) {
  in_every_dimension([]<int dim>() {
    auto mesh = distorted_meshes<dim>()[0];
    auto made = method<dim>();
    std::size_t n_stages = 0;
    for (const auto& parameter : made.parameters())
      if (parameter.name.ends_with(".solves")) {
        made.set(parameter.name, "4");
        ++n_stages;
      }
    std::vector<SolveEffort> efforts;
    smooth(mesh, made, [&](const IterationRecord& record, const auto&) {
      ASSERT_TRUE(record.solves.has_value());
      EXPECT_LE(record.solves->seconds, record.smoothing_seconds);
      efforts.push_back(*record.solves);
    });
    EXPECT_EQ(efforts.front().n_solves, 0u);
    EXPECT_GE(efforts.back().n_solves, 4u);
    EXPECT_LE(efforts.back().n_solves, 4 * n_stages);
  });
}

TEST_P(EveryMethodWithAProblem, IsBitwiseIdenticalForEveryRunAndNumberOfThreads) {
  const int default_threads = n_threads();
  in_every_dimension([]<int dim>() {
    const auto mesh = distorted_meshes<dim>()[0];
    std::vector<Mesh<dim>> results;
    auto reused = method<dim>();
    for (const int threads : {1, 2, 3}) {
      set_n_threads(threads);
      auto made = method<dim>();
      for (auto* each : {&made, &reused}) {
        results.push_back(mesh);
        smooth(results.back(), *each);
        EXPECT_EQ(results.back().copied_coordinates(), results.front().copied_coordinates());
      }
    }
  });
  set_n_threads(default_threads);
}

TEST_P(EveryMethodWithAProblem, AcceptsMeshesWithoutFreeNodes) {
  const auto free = unit_square(3, Cells::triangles, 0.2);
  const auto mesh =
      Mesh<2>(std::make_shared<const Topology>(2, free.n_nodes(), free.topology().cells(),
                                               std::vector<bool>(free.n_nodes(), true)),
              free.copied_coordinates());
  Mesh<2> result = mesh;
  auto made = method<2>();
  smooth(result, made);
  EXPECT_EQ(result.copied_coordinates(), mesh.copied_coordinates());
}

TEST_P(EveryMethodWithAProblem, RefusesTangledMeshes) {
  auto mesh = unit_square(6, Cells::triangles, 0.0);
  mesh.coordinates()[mesh.topology().free_nodes()[0]] += Point<2>(0.4, 0.4);
  auto made = method<2>();
  EXPECT_THROW(smooth(mesh, made), InputError);
}

TEST_P(EveryMethodWithAProblem, RefusesToRunWithoutAProblem) {
  auto mesh = unit_square(4, Cells::triangles, 0.2);
  auto made = make_method<2>(GetParam());
  EXPECT_THAT([&] { smooth(mesh, made); },
              ThrowsMessage<InputError>(AllOf(HasSubstr(GetParam()), HasSubstr("problem"))));
}

TEST_P(EveryMethodWithAProblem, StartsWithTheGivenMethod) {
  const auto mesh = unit_square(8, Cells::triangles, 0.3);
  const auto started = [&](const std::string& start) {
    Mesh<2> result = mesh;
    auto made = method<2>();
    made.set("start.method", start);
    std::vector<Point<2>> first;
    smooth(result, made, [&](const IterationRecord& record, const auto& seen) {
      if (record.stage == "start") first = seen.copied_coordinates();
    });
    return first;
  };
  EXPECT_EQ(started("none"), mesh.copied_coordinates());
  Mesh<2> smoothed = mesh;
  auto smart = make_method<2>("smart-laplace");
  smooth(smoothed, smart);
  EXPECT_EQ(started("smart-laplace"), smoothed.copied_coordinates());
  EXPECT_THAT([&] { started("energy-descent"); },
              ThrowsMessage<InputError>(HasSubstr("start.method")));
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryMethodWithAProblem, testing::ValuesIn(names()),
                         test::test_name);

TEST(MethodsWithAProblem, AreNotAmongAll) {
  for (const auto& info : method_catalogue()) EXPECT_FALSE(info.needs_problem()) << info.name;
  EXPECT_THAT(names(),
              testing::IsSupersetOf({"energy-descent", "indicator-weighted", "indicator-aligned"}));
}

/// In the solution's layer cells become thin across it and keep their length along it.
TEST(MethodsWithAProblem, IndicatorAlignedMakesCellsThinAcrossALayer) {
  const auto mesh = unit_square(24, Cells::quadrilaterals, 0.0);
  const auto extents = [&](const std::string& name) {
    auto made = make_method<2>(name);
    made.problem = make_poisson_problem<2>(derived_solution<2>("exp(-20*x)", {}, {}));
    Mesh<2> result = mesh;
    smooth(result, made);
    Point<2> sum = Point<2>::Zero();  // of the cells at the middle of the layer
    for (const CellIndex c : {CellIndex{11 * 24}, CellIndex{12 * 24}}) {
      const auto nodes = result.topology().cell_nodes(c);
      Point<2> lower = result.coordinates()[nodes[0]], upper = lower;
      for (const NodeIndex i : nodes) {
        lower = lower.cwiseMin(result.coordinates()[i]);
        upper = upper.cwiseMax(result.coordinates()[i]);
      }
      sum += 0.5 * 24.0 * (upper - lower);
    }
    return sum;
  };
  const Point<2> aligned = extents("indicator-aligned");
  EXPECT_LT(aligned[0], 0.5);
  EXPECT_NEAR(aligned[1], 1.0, 0.1);
}

/// Nodes of the sides stay on them, corners do not move, and the error falls further.
TEST(MethodsWithAProblem, CanSlideBoundaryNodes) {
  for (const std::string method : {"indicator-weighted", "indicator-aligned", "indicator-getme",
                                   "indicator-mmpde", "indicator-mmpde-descent"})
    for (const Cells cells : {Cells::triangles, Cells::quadrilaterals}) {
      const auto mesh = unit_square(12, cells, 0.1);
      PoissonSolver<2> solver(&mesh, {.load = Load::quadrature,
                                      .condition_number = ConditionNumberMethod::none,
                                      .jacobi_cg = Recorded::never});
      const auto error_with = [&](const std::string& boundary) {
        auto made = make_method<2>(method);
        made.problem = make_poisson_problem<2>(layer<2>());
        for (const auto& parameter : made.parameters())
          if (parameter.name.ends_with(".boundary")) made.set(parameter.name, boundary);
        Mesh<2> result = mesh;
        smooth(result, made, [&](const IterationRecord& record, const auto&) {
          EXPECT_EQ(record.quality.n_invalid, 0u);
        });
        std::size_t n_moved = 0;
        for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
          const Point<2>&from = mesh.coordinates()[i], &to = result.coordinates()[i];
          for (int d = 0; d < 2; ++d)
            if (from[d] == 0.0 || from[d] == 1.0) {
              EXPECT_NEAR(to[d], from[d], 1e-12);
            }
          n_moved += mesh.topology().on_boundary()[i] && (to - from).norm() > 1e-6;
        }
        EXPECT_EQ(n_moved > 0, boundary == "slide");
        return solver.solve(result.coordinates(), layer<2>()).h1_error;
      };
      EXPECT_LT(error_with("slide"), error_with("fixed")) << method;
    }
}

/// The residual leads to small cells in the same places.
TEST(MethodsWithAProblem, CanUseTheResidualIndicator) {
  for (const std::string method : {"indicator-weighted.weights", "indicator-getme.sizes"}) {
    const auto dot = method.find('.');
    for (const auto& mesh : distorted_meshes<2>()) {
      PoissonSolver<2> solver(&mesh, {.load = Load::quadrature,
                                      .condition_number = ConditionNumberMethod::none,
                                      .jacobi_cg = Recorded::never});
      const auto error_with = [&](const std::string& indicator) {
        auto made = make_method<2>(method.substr(0, dot));
        made.problem = make_poisson_problem<2>(layer<2>());
        made.set(method.substr(dot + 1) + ".indicator", indicator);
        Mesh<2> result = mesh;
        smooth(result, made);
        return solver.solve(result.coordinates(), layer<2>()).h1_error;
      };
      const double recovery = error_with("recovery"), residual = error_with("residual");
      EXPECT_NE(recovery, residual);
      EXPECT_LT(residual, 1.2 * recovery);
    }
  }
}

/// The energy falls by less and less. The stage ends when the last solve's share of the total is
/// small enough.
TEST(MethodsWithAProblem, EnergyDescentStopsByTheGainOfASolve) {
  const auto solves_with = [](const char* gain) {
    auto mesh = unit_square(12, Cells::triangles, 0.2);
    const auto problem = make_poisson_problem<2>(layer<2>());
    auto made = make_method<2>("energy-descent");
    made.problem = problem;
    made.set("descent.solves", "30");
    made.set("descent.gain", gain);
    std::size_t n_solves = 0;
    smooth(mesh, made,
           [&](const IterationRecord& record, const auto&) { n_solves = record.solves->n_solves; });
    return n_solves;
  };
  const std::size_t all = solves_with("0"), some = solves_with("0.02");
  const std::size_t few = solves_with("0.2");
  EXPECT_EQ(all, 30u);
  EXPECT_LT(some, all);
  EXPECT_LT(few, some);
}

/// No cell becomes worse than the floor, or than the worst of the start.
TEST(MethodsWithAProblem, EnergyDescentKeepsItsQualityFloor) {
  auto mesh = unit_square(12, Cells::triangles, 0.2);
  auto made = make_method<2>("energy-descent");
  made.problem = make_poisson_problem<2>(layer<2>());
  made.set("descent.quality_floor", "0.6");
  made.set("descent.solves", "30");
  double start = 0.0;
  smooth(mesh, made, [&](const IterationRecord& record, const auto&) {
    if (record.stage == "start") start = record.quality.q_min;
    if (record.stage == "descent") {
      EXPECT_GE(record.quality.q_min, std::min(0.6, start));
    }
  });
}

}  // namespace
}  // namespace smoothfem
