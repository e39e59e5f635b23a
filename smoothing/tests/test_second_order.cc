// SPDX-License-Identifier: GPL-3.0-or-later
/// Smoothing of meshes of second order: where midside nodes go, and that cells stay valid.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "smoothing/base/parallel.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/second_order/curved_quality.h"
#include "smoothing/second_order/midside_placement.h"
#include "smoothing/second_order/raise_order.h"
#include "smoothing/tests/curved_cells.h"
#include "smoothing/tests/curved_meshes.h"
#include "smoothing/tests/methods.h"

namespace smoothfem {
namespace {

using test::box_mesh;
using test::BoxCells;
using test::four_triangles;
using test::grid_mesh;
using test::GridCells;
using test::random_curved_mesh;
using test::small_meshes;

SmoothingResult smooth_by(const std::string& name, auto& mesh) {
  auto method = make_method<std::decay_t<decltype(mesh)>::PointType::RowsAtCompileTime>(name);
  return smooth(mesh, method);
}

TEST(SecondOrder, MidsideNodesInsideGoToTheMiddleAndThoseOfTheBoundaryStay) {
  PlanarMesh mesh = four_triangles({1.3, 0.8}, 0.2);
  const auto before = mesh.copied_coordinates();
  auto method = make_method<2>("laplace");
  const SmoothingResult result = smooth(mesh, method);
  const auto x = std::as_const(mesh).coordinates();
  EXPECT_NEAR((x[4] - Point<2>(1.0, 1.0)).norm(), 0.0, 1e-2);
  for (CellIndex c = 0; c < 4; ++c) {
    const auto corners = mesh.topology().cell_nodes(c), midside = mesh.topology().midside_nodes(c);
    EXPECT_EQ(x[midside[0]], before[midside[0]]);  // of the boundary
    for (const int k : {1, 2})
      EXPECT_EQ(x[midside[k]], 0.5 * (x[corners[k]] + x[corners[(k + 1) % 3]]));
  }
  EXPECT_EQ(result.midside.n_bent, 0u);
  EXPECT_EQ(result.quality.n_invalid, 0u);
}

TEST(SecondOrder, NodesWithoutMovedCornersKeepEveryBit) {
  PlanarMesh mesh = with_midside_nodes(grid_mesh(3, GridCells::quadrilaterals));
  test::Random random(5);
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    for (const NodeIndex node : mesh.topology().midside_nodes(c))
      mesh.coordinates()[node] += 0.03 * Point<2>(random(), random());
  const auto before = mesh.copied_coordinates();
  smooth_by("smart-laplace", mesh);  // a regular grid of corners
  EXPECT_EQ(mesh.copied_coordinates(), before);
}

/// The boundary bulges, so that straight edges inside would make an invalid cell.
TEST(SecondOrder, NodesInsideBendAgainWhereStraightEdgesMakeCellsInvalid) {
  PlanarMesh mesh = four_triangles({1.02, 1.0}, 0.55);
  EXPECT_EQ(mesh_quality(mesh).n_invalid, 1u);  // det J < 0 at the lower corners
  const auto midside = mesh.topology().midside_nodes(0);
  mesh.coordinates()[midside[1]] += Point<2>(0.05, 0.05);
  mesh.coordinates()[midside[2]] += Point<2>(-0.05, 0.05);
  ASSERT_EQ(mesh_quality(mesh).n_invalid, 0u);
  const MidsidePlacement<2> placement(mesh);
  mesh.coordinates()[4] = {1.0, 1.0};
  std::vector<double> quality;
  const MidsideReport report = placement.place(mesh, 0.0, quality);
  EXPECT_GT(report.n_bent, 0u);
  EXPECT_EQ(report.n_reset, 0u);
  EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
  EXPECT_EQ(std::as_const(mesh).coordinates()[4], Point<2>(1.0, 1.0));
}

TEST(SecondOrder, InvalidCurvedCellsAreRepairedAndCounted) {
  PlanarMesh mesh = four_triangles({1.0, 1.0}, 0.7);  // beyond half the height
  ASSERT_EQ(mesh_quality(mesh).n_invalid, 1u);
  const SmoothingResult result = smooth_by("getme", mesh);
  EXPECT_EQ(result.midside.n_repaired, 1u);
  EXPECT_EQ(result.midside.n_relaxed, 1u);
  EXPECT_EQ(result.midside.n_relaxed_on_boundary, 1u);
  EXPECT_EQ(result.quality.n_invalid, 0u);
  const Point<2> relaxed = std::as_const(mesh).coordinates()[mesh.topology().midside_nodes(0)[0]];
  EXPECT_LT(relaxed.y(), 0.5);
  EXPECT_GT(relaxed.y(), 0.3);
}

TEST(SecondOrder, RaisedMeshesHaveTheNumbersOfNodesThatEulerGives) {
  const auto box = box_mesh(2, 2, 2, BoxCells::hexahedra);
  const auto& topology = box.topology();
  const std::size_t with_edges = box.n_nodes() + topology.n_edges();
  EXPECT_EQ(with_midside_nodes(box, SecondOrderKind::serendipity).n_nodes(), with_edges);
  EXPECT_EQ(with_midside_nodes(box).n_nodes(), with_edges + topology.n_facets() + box.n_cells());
  EXPECT_EQ(mesh_quality(with_midside_nodes(box)).q_min, 1.0);
}

// --- Every method on random curved meshes --------------------------------------------------------

/// Number of sampled points of the cells where det J is not positive.
template <int dim>
std::size_t n_bad_samples(const Mesh<dim>& mesh) {
  std::size_t n_bad = 0;
  test::Random random(3);
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto corners = mesh.topology().cell_nodes(c), midside = mesh.topology().midside_nodes(c);
    std::vector<Point<dim>> nodes;
    for (const auto row : {corners, midside})
      for (const NodeIndex node : row) nodes.push_back(mesh.coordinates()[node]);
    const SecondOrderType type = second_order_types[second_order_type(dim, nodes.size())];
    static std::map<std::size_t, test::Gradients> known;
    auto& gradients = known[nodes.size() + 100 * dim];
    if (gradients.empty())
      gradients = test::gradients_at(type, test::reference_samples(type, 60, random));
    for (const auto& at : gradients) n_bad += !(test::jacobian(nodes, at) > 0.0);
  }
  return n_bad;
}

class EveryMethodOnCurvedMeshes : public testing::TestWithParam<std::string> {};

TEST_P(EveryMethodOnCurvedMeshes, ReturnsCellsWithPositiveDeterminants) {
  const auto check = [&]<int dim>() {
    if (!supports_mesh_kind<dim>(GetParam())) return;
    std::uint64_t seed = 1;
    for (const auto kind : {SecondOrderKind::complete, SecondOrderKind::serendipity})
      for (const auto& [name, linear] : small_meshes<dim>()) {
        SCOPED_TRACE(name);
        auto method = test::short_method<dim>(GetParam(), "20");
        if (method.info.needs_problem()) return;
        for (int i = 0; i < (dim == 2 ? 3 : 1); ++i) {
          const Mesh<dim> initial = random_curved_mesh(linear, kind, ++seed);
          Mesh<dim> mesh = initial;
          const SmoothingResult result = smooth(mesh, method);
          EXPECT_EQ(result.quality.n_invalid, 0u);
          EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
          EXPECT_EQ(n_bad_samples(mesh), 0u);
          for (NodeIndex node = 0; node < linear.n_nodes(); ++node)
            if (initial.topology().is_fixed(node)) {
              EXPECT_EQ(std::as_const(mesh).coordinates()[node],
                        std::as_const(initial).coordinates()[node]);
            }
        }
      }
  };
  check.template operator()<2>();
  check.template operator()<3>();
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryMethodOnCurvedMeshes,
                         testing::ValuesIn(test::method_names()), test::test_name);

TEST(SecondOrder, SamplesFindWhatTheProofForbids) {
  const auto linear = grid_mesh(4, GridCells::triangles);
  Mesh<2> mesh = random_curved_mesh(linear, SecondOrderKind::complete, 1);
  const NodeIndex midside = mesh.topology().midside_nodes(0)[0];
  mesh.coordinates()[midside] += Point<2>(0.0, 0.6);
  EXPECT_GT(mesh_quality(mesh).n_invalid, 0u);
  EXPECT_GT(n_bad_samples(mesh), 0u);
}

TEST(SecondOrder, ResultsDoNotDependOnThreads) {
  const Mesh<3> initial =
      random_curved_mesh(box_mesh(2, 2, 2, BoxCells::tetrahedra), SecondOrderKind::complete, 4);
  const int n = n_threads();
  std::vector<std::vector<Point<3>>> results;
  for (const int threads : {1, 3}) {
    set_n_threads(threads);
    Mesh<3> mesh = initial;
    smooth_by("getme", mesh);
    results.push_back(mesh.copied_coordinates());
  }
  set_n_threads(n);
  EXPECT_EQ(results[0], results[1]);
}

TEST(SecondOrder, ObserversGetPlacedMeshesAndTheirQuality) {
  PlanarMesh mesh = four_triangles({1.3, 0.8}, 0.2);
  auto method = make_method<2>("laplace");
  std::size_t n = 0;
  smooth(mesh, method, [&](const IterationRecord& record, const PlanarMesh& now) {
    ++n;
    EXPECT_NE(now.topology().midside(), nullptr);
    EXPECT_EQ(record.quality.q_mean, mesh_quality(now).q_mean);
    const auto x = now.coordinates();
    const auto corners = now.topology().cell_nodes(2), midside = now.topology().midside_nodes(2);
    EXPECT_NEAR((x[midside[1]] - 0.5 * (x[corners[1]] + x[corners[2]])).norm(), 0.0, 1e-15);
  });
  EXPECT_GT(n, 1u);
}

}  // namespace
}  // namespace smoothfem
