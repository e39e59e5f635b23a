// SPDX-License-Identifier: GPL-3.0-or-later
// A record on a mesh of which each rank has a part is that of the whole mesh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mpi.h>

#include "distributed/distributed_mesh.h"
#include "distributed/partition.h"
#include "distributed/tests/scattered.h"
#include "fem/poisson_solver.h"
#include "fem/tests/all_ranks.h"
#include "fem/tests/same_record.h"
#include "fem/tests/unit_mesh.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using test::all_ranks;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// The CG iterates of two runs agree to 1e-8 only if they are converged further than that.
PoissonOptions exact_options() {
  return {.cg_tolerance = 1e-13};
}

template <int dim>
DistributedMesh<dim> in_parts(const Mesh<dim>& mesh, bool balances) {
  auto spread = scattered(all_ranks(), mesh);
  return distribute(all_ranks(),
                    balances ? balanced(all_ranks(), std::move(spread)) : std::move(spread));
}

class RecordsInPartsTest : public testing::TestWithParam<Case> {};

// Ranks that wait for each other on busy cores take long: few cases.
INSTANTIATE_TEST_SUITE_P(Elements, RecordsInPartsTest,
                         testing::Values(Case{Cells::mixed, 1}, Case{Cells::tetrahedra, 1},
                                         Case{Cells::hexahedra, 1}, Case{Cells::mixed_volume, 1}),
                         [](const auto& info) { return name_of(info.param); });

TEST_P(RecordsInPartsTest, EqualThoseOfTheWholeMesh) {
  GetParam().on_mesh(7, 4, 0.2, [&]<int dim>(const Mesh<dim>& mesh) {
    const auto& solution = manufactured_solution<dim>("sine");
    PoissonSolver<dim> alone(&mesh, exact_options());
    const auto expected = alone.solve(mesh.coordinates(), solution);
    const auto expected_errors = alone.nodal_errors();
    const auto shared =
        PoissonSolver<dim>(all_ranks().is_root() ? &mesh : nullptr, exact_options(), all_ranks())
            .solve(mesh.coordinates(), solution);
    for (const bool balances : {false, true}) {  // without: every cell is next to other ranks
      const auto parts = in_parts(mesh, balances);
      PoissonSolver<dim> solver(&parts.part, exact_options(), all_ranks());
      const auto record = solver.solve(parts.part.coordinates(), solution);
      expect_same(record, expected);
      expect_same(record, shared);
      const auto errors = solver.nodal_errors();
      const auto numbers = parts.part.topology().part()->nodes();
      ASSERT_EQ(errors.size(), numbers.size());
      for (std::size_t i = 0; i < errors.size(); ++i)
        EXPECT_NEAR(errors[i], expected_errors[numbers[i]], 1e-8 * record.e_max);
    }
  });
}

TEST(RecordsInParts, FollowTheSmoothedMesh) {
  const Case planar{Cells::triangles, 1};
  planar.on_mesh(6, 3, 0.3, [&]<int dim>(const Mesh<dim>& mesh) {
    auto parts = in_parts(mesh, true);
    const auto& solution = manufactured_solution<dim>("sine");
    auto method = make_method<dim>("smart-laplace");
    PoissonSolver<dim> solver(&parts.part, exact_options(), all_ranks());
    std::vector<SolutionRecord> records;
    smooth(parts.part, method, [&](const IterationRecord&, const Mesh<dim>& now) {
      records.push_back(solver.solve(now.coordinates(), solution, false));
    });
    Mesh<dim> whole = mesh;
    PoissonSolver<dim> alone(&mesh, exact_options());
    auto same_method = make_method<dim>("smart-laplace");
    std::size_t next = 0;
    smooth(whole, same_method, [&](const IterationRecord&, const Mesh<dim>& now) {
      ASSERT_LT(next, records.size());
      expect_same(records[next++], alone.solve(now.coordinates(), solution, false));
    });
    EXPECT_EQ(next, records.size());
    EXPECT_GT(next, 2U);
    EXPECT_NE(records.front().l2_error, records.back().l2_error);
  });
}

TEST(RecordsInParts, AllRanksHaveTheSameRecord) {
  const auto parts = in_parts(unit_cube(4, Cells::hexahedra, 0.2), true);
  const auto record = PoissonSolver<3>(&parts.part, exact_options(), all_ranks())
                          .solve(parts.part.coordinates(), manufactured_solution<3>("sine"));
  std::array numbers{record.condition_number, record.e_max, record.l2_error,
                     static_cast<double>(record.cg_iterations)};
  const auto own = numbers;
  all_ranks().broadcast(numbers);
  EXPECT_EQ(own, numbers);
}

/// Multigrid needs the numbers of all columns; its aggregates are those of each rank.
TEST(RecordsInParts, MultigridConverges) {
  const auto parts = in_parts(unit_cube(6, Cells::hexahedra, 0.2), true);
  const PoissonOptions options{.condition_number = ConditionNumberMethod::lanczos,
                               .multigrid_cg = Recorded::always};
  const auto record = PoissonSolver<3>(&parts.part, options, all_ranks())
                          .solve(parts.part.coordinates(), manufactured_solution<3>("sine"), false);
  EXPECT_EQ(record.status, "ok");
  EXPECT_GT(record.amg_cg_iterations, 0U);
  EXPECT_LT(record.amg_cg_iterations, 30U);
}

TEST(RecordsInParts, FewDofsAreEnoughForEachRank) {
  const auto parts = in_parts(unit_cube(2, Cells::hexahedra, 0.0), true);
  const auto record = PoissonSolver<3>(&parts.part, PoissonOptions{}, all_ranks())
                          .solve(parts.part.coordinates(), manufactured_solution<3>("quadratic"));
  EXPECT_EQ(record.n_dofs, 27U);
  EXPECT_EQ(record.n_free, 1U);
  EXPECT_NEAR(record.condition_number, 1.0, 1e-14);
}

TEST(RecordsInParts, RefusesOnAllRanksWhatNeedsTheWholeMesh) {
  const auto parts = in_parts(unit_cube(3, Cells::hexahedra, 0.2), true);
  const auto make = [&](const PoissonOptions& options) {
    PoissonSolver<3>(&parts.part, options, all_ranks());
  };
  EXPECT_THAT([&] { make({.degree = 2}); }, ThrowsMessage<InputError>(HasSubstr("have degree 1")));
  EXPECT_THAT([&] { make({.natural_groups = {"right"}}); },
              ThrowsMessage<InputError>(HasSubstr("whole boundary")));
  // All nodes lie on the boundary.
  const auto no_unknown = in_parts(test::box_mesh(8, 1, 1, test::BoxCells::hexahedra), true);
  EXPECT_THAT([&] { PoissonSolver<3>(&no_unknown.part, PoissonOptions{}, all_ranks()); },
              ThrowsMessage<InputError>(HasSubstr("no unknown")));
}

}  // namespace
}  // namespace smoothfem
