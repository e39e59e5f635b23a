/// What every method has to hold, whichever it is: a new one is tested by being registered.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "smoothing/loop/smooth.h"
#include "smoothing/tests/planar_meshes.h"

namespace smoothfem {
namespace {

using test::grid_mesh;
using test::GridCells;

std::vector<std::pair<std::string, PlanarMesh>> distorted_meshes() {
  std::vector<std::pair<std::string, PlanarMesh>> all{
      {"triangles", grid_mesh(7, GridCells::triangles)},
      {"quadrilaterals", grid_mesh(7, GridCells::quadrilaterals)},
      {"mixed", grid_mesh(7, GridCells::mixed)},
      {"pentagons", test::pentagon_mesh()},
      {"hexagons", test::honeycomb_mesh()}};
  for (auto& [name, mesh] : all) test::distort(mesh, 0.25, 7);
  return all;
}

class EveryMethod : public testing::TestWithParam<std::string> {
 protected:
  /// The method with so few iterations that differences in rounding cannot grow.
  static Method<2> short_method() {
    Method<2> method = make_method<2>(GetParam());
    for (const auto& parameter : method.parameters())
      if (parameter.name.ends_with("max_iterations") || parameter.name.ends_with("max_cycles"))
        method.set(parameter.name, "5");
    return method;
  }
  static bool claims_validity() {
    for (const auto& stage : make_method<2>(GetParam()).stages)
      if (!stage->rule().needs_valid_mesh) return false;
    return true;
  }
};

double farthest(const PlanarMesh& a, const PlanarMesh& b) {
  double longest = 0.0;
  for (std::size_t i = 0; i < a.n_nodes(); ++i)
    longest = std::max(longest, (a.coordinates()[i] - b.coordinates()[i]).norm());
  return longest;
}

TEST_P(EveryMethod, ImprovesDistortedMeshesOfEveryTypeAndMovesOnlyFreeNodes) {
  for (const auto& [name, mesh] : distorted_meshes()) {
    PlanarMesh result = mesh;
    Method<2> method = make_method<2>(GetParam());
    smooth(result, method);
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      if (mesh.topology().is_fixed(i)) {
        EXPECT_EQ(result.coordinates()[i], mesh.coordinates()[i]) << name << " node " << i;
      }
    EXPECT_EQ(&result.topology(), &mesh.topology()) << name;
    EXPECT_GT(mesh_quality(result).q_star_min, mesh_quality(mesh).q_star_min) << name;
    EXPECT_GT(mesh_quality(result).q_mean, mesh_quality(mesh).q_mean) << name;
  }
}

TEST_P(EveryMethod, LeavesRegularPatchesWhereTheyAre) {
  for (const auto& mesh : {grid_mesh(6, GridCells::quadrilaterals),
                           grid_mesh(6, GridCells::triangles, true), test::honeycomb_mesh()}) {
    PlanarMesh result = mesh;
    Method<2> method = short_method();
    smooth(result, method);
    EXPECT_LT(farthest(result, mesh), 1e-11);
  }
}

TEST_P(EveryMethod, CommutesWithSimilarities) {
  const Eigen::Rotation2Dd rotation(0.9);
  const Point<2> shift(30.0, -70.0);
  for (const double scale : {1e-3, 25.0})
    for (const auto& [name, mesh] : distorted_meshes()) {
      const auto similar = [&](PlanarMesh m) {
        for (auto& p : m.coordinates()) p = scale * (rotation * p + shift);
        return m;
      };
      PlanarMesh here = mesh, there = similar(mesh);
      Method<2> first = short_method(), second = short_method();
      const auto a = smooth(here, first), b = smooth(there, second);
      EXPECT_EQ(a.iterations_text(), b.iterations_text()) << name;
      EXPECT_LT(farthest(similar(here), there), 1e-9 * scale) << name;
    }
}

TEST_P(EveryMethod, GivesTheSameBitsTwice) {
  for (const auto& [name, mesh] : distorted_meshes()) {
    PlanarMesh first = mesh, second = mesh;
    Method<2> method = make_method<2>(GetParam()), other = make_method<2>(GetParam());
    smooth(first, method);
    smooth(second, other);
    EXPECT_EQ(first.coordinates(), second.coordinates()) << name;
    PlanarMesh again = mesh;
    smooth(again, method);
    EXPECT_EQ(first.coordinates(), again.coordinates()) << name << ": the method keeps a state";
  }
}

TEST_P(EveryMethod, TellsTheObserverEveryIteration) {
  for (const auto& [name, mesh] : distorted_meshes()) {
    PlanarMesh result = mesh;
    Method<2> method = make_method<2>(GetParam());
    std::vector<IterationRecord> records;
    const auto summary = smooth(result, method, [&](const auto& record, const auto& seen) {
      const MeshQuality quality = mesh_quality(seen);
      EXPECT_EQ(record.quality.q_min, quality.q_min) << name;
      EXPECT_EQ(record.quality.q_mean, quality.q_mean) << name;
      EXPECT_EQ(record.quality.q_star_min, quality.q_star_min) << name;
      if (record.record == 0) {
        EXPECT_EQ(seen.coordinates(), mesh.coordinates()) << name;
      }
      records.push_back(record);
    });
    ASSERT_GT(records.size(), method.stages.size()) << name;
    EXPECT_EQ(records[0].stage, "initial");
    for (std::size_t i = 1; i < records.size(); ++i) {
      EXPECT_EQ(records[i].record, i);
      EXPECT_GE(records[i].smoothing_seconds, records[i - 1].smoothing_seconds);
      if (records[i].stage == records[i - 1].stage) {
        EXPECT_GT(records[i].iteration, records[i - 1].iteration);
      }
    }
    EXPECT_EQ(records.back().iteration, summary.stages.back().iterations);
    EXPECT_EQ(summary.quality.q_mean, mesh_quality(result).q_mean) << name;
  }
}

TEST_P(EveryMethod, KeepsTheMeshValidIfItClaimsSo) {
  if (!claims_validity()) GTEST_SKIP() << "does not claim it";
  for (auto& [name, mesh] : distorted_meshes()) {
    test::distort(mesh, 0.9, 11);
    Method<2> method = make_method<2>(GetParam());
    smooth(mesh, method, [&](const IterationRecord& record, const PlanarMesh& seen) {
      EXPECT_EQ(mesh_quality(seen).n_invalid, 0u) << name << ' ' << record.record;
    });
  }
}

TEST_P(EveryMethod, RefusesTangledMeshesIfItNeedsValidOnes) {
  auto mesh = grid_mesh(4, GridCells::triangles);
  mesh.coordinates()[6] = {3.0, 3.5};
  const auto tangled = mesh.coordinates();
  Method<2> method = make_method<2>(GetParam());
  if (claims_validity()) {
    EXPECT_THROW(smooth(mesh, method), InputError);
    EXPECT_EQ(mesh.coordinates(), tangled);
  } else {
    EXPECT_NO_THROW(smooth(mesh, method));
    EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u) << "these grids untangle";
  }
}

TEST_P(EveryMethod, TakesUnusedNodes) {
  const auto grid = grid_mesh(5, GridCells::quadrilaterals);
  test::Cells cells;
  for (CellIndex c = 0; c < grid.n_cells(); ++c) {
    const auto nodes = grid.topology().cell_nodes(c);
    cells.emplace_back(nodes.begin(), nodes.end());
  }
  auto coordinates = grid.coordinates();
  coordinates.emplace_back(2.2, 2.2);
  auto with_unused = test::make_mesh(coordinates, cells), without = grid;
  test::distort(with_unused, 0.3, 2);
  test::distort(without, 0.3, 2);
  Method<2> method = make_method<2>(GetParam()), other = make_method<2>(GetParam());
  smooth(with_unused, method);
  smooth(without, other);
  EXPECT_EQ(with_unused.coordinates().back(), Point<2>(2.2, 2.2));
  for (std::size_t i = 0; i < without.n_nodes(); ++i)
    EXPECT_EQ(with_unused.coordinates()[i], without.coordinates()[i]) << i;
}

TEST_P(EveryMethod, TakesMeshesWithNothingToMove) {
  auto mesh = test::make_mesh({{0, 0}, {1, 0}, {1, 1}, {0, 2}}, {{0, 1, 2}, {0, 2, 3}});
  const auto before = mesh.coordinates();
  Method<2> method = make_method<2>(GetParam());
  smooth(mesh, method);
  EXPECT_EQ(mesh.coordinates(), before);
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& info : method_catalogue()) names.push_back(info.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryMethod, testing::ValuesIn(method_names()),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace smoothfem
