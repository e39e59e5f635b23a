// SPDX-License-Identifier: GPL-3.0-or-later
/// Tests volume meshes whose boundary nodes slide on the initial boundary.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "smoothing/base/parallel.h"
#include "smoothing/geometry/cell_size.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/surface/sliding_boundary.h"
#include "smoothing/tests/methods.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using test::box_mesh;
using test::BoxCells;

double volume(const VolumeMesh& mesh) {
  double sum = 0.0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) sum += signed_cell_size(mesh, c);
  return sum;
}

/// A box whose nodes, also those of its sides, were moved at random where they may move.
VolumeMesh disturbed_box(BoxCells cells, std::uint32_t n = 4) {
  VolumeMesh mesh = with_sliding_boundary(box_mesh(n, n, n, cells));
  test::Random random(2);
  for (const NodeIndex i : mesh.topology().free_nodes()) {
    const Point<3> old = mesh.coordinates()[i];
    const double a = random(), b = random(), c = random();
    mesh.coordinates()[i] = allowed_position(mesh, i, Point<3>(old + 0.3 * Point<3>(a, b, c)));
    for (const CellIndex cell : mesh.topology().node_cells(i))
      if (!(cell_mean_ratio(mesh, cell) > 0.0)) mesh.coordinates()[i] = old;
  }
  return mesh;
}

/// A quarter of a tube, whose inner and outer sides are curved. unevenness: cells at one end are
/// longer by this share than those in the middle, cells at the other end are shorter.
VolumeMesh tube(std::uint32_t n, double unevenness = 0.0) {
  VolumeMesh mesh = box_mesh(n, n, n, BoxCells::hexahedra);
  for (auto& p : mesh.coordinates()) {
    const double x = p.x() / n, along = x + unevenness * x * (1.0 - x);
    const double angle = 0.5 * std::numbers::pi * (1.0 - along), radius = 1.0 + p.y() / n;
    p = {radius * std::cos(angle), radius * std::sin(angle), p.z() / n};
  }
  return mesh;
}

double facet_distance(const VolumeMesh& mesh) {
  return mesh.constraints()->facet_distance(mesh.coordinates());
}

std::size_t n_slid_nodes(const VolumeMesh& before, const VolumeMesh& after) {
  std::size_t n = 0;
  for (NodeIndex i = 0; i < before.n_nodes(); ++i)
    n += before.topology().on_boundary()[i] && before.coordinates()[i] != after.coordinates()[i];
  return n;
}

class SlidingBoundary : public testing::TestWithParam<std::string> {
 protected:
  static Method<3> method() { return make_method<3>(GetParam()); }
};

TEST_P(SlidingBoundary, KeepsABoxABox) {
  for (const auto cells : {BoxCells::tetrahedra, BoxCells::prisms, BoxCells::hexahedra}) {
    const VolumeMesh mesh = disturbed_box(cells);
    EXPECT_EQ(mesh.n_nodes() - mesh.topology().free_nodes().size(), 8u) << "its corners";
    VolumeMesh result = mesh;
    auto made = method();
    smooth(result, made);
    EXPECT_EQ(test::n_moved_fixed_nodes(mesh, result), 0u);
    EXPECT_LT(facet_distance(result), 1e-12);
    EXPECT_NEAR(volume(result), 64.0, 1e-11);
    EXPECT_GT(mesh_quality(result).q_mean, mesh_quality(mesh).q_mean);
    EXPECT_EQ(mesh_quality(result).n_invalid, 0u);
    EXPECT_GT(n_slid_nodes(mesh, result), 20u);
  }
}

TEST_P(SlidingBoundary, KeepsNodesOnACurvedBoundaryAndMeasuresFacetDistances) {
  const VolumeMesh mesh = with_sliding_boundary(tube(6));
  VolumeMesh result = mesh;
  auto made = method();
  smooth(result, made);
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    if (mesh.topology().on_boundary()[i]) {
      EXPECT_LT(mesh.constraints()->distance(result.coordinates()[i]), 1e-13) << i;
    }
  if (test::claims_validity(made)) {
    EXPECT_EQ(mesh_quality(result).n_invalid, 0u);
  }
  // Largest sag of a chord between points of the outer side that are half a division apart.
  constexpr double outer_sag = 2.0 * (1.0 - 0.9914448613738104);  // cos(7.5 degrees)
  EXPECT_LT(facet_distance(mesh), 1e-13);
  EXPECT_LT(facet_distance(result), 2.0 * outer_sag);
}

TEST_P(SlidingBoundary, KeepsFacetsWithinTheirBound) {
  const VolumeMesh initial = tube(6, 0.6);
  const auto smoothed = [&](double slide_distance) {
    VolumeMesh mesh = with_sliding_boundary(initial, {}, slide_distance);
    auto made = method();
    smooth(mesh, made);
    EXPECT_GT(n_slid_nodes(initial, mesh), 0u) << slide_distance;
    return mesh;
  };
  const double unbounded = facet_distance(smoothed(NodeConstraints<3>::unbounded));
  const double edge = with_sliding_boundary(initial, {}, 1.0).constraints()->facet_bound();
  for (const double share : {0.7, 0.3}) {
    const VolumeMesh mesh = smoothed(share * unbounded / edge);
    EXPECT_DOUBLE_EQ(mesh.constraints()->facet_bound(), share * unbounded);
    EXPECT_LE(facet_distance(mesh), mesh.constraints()->facet_bound());
  }
}

TEST_P(SlidingBoundary, IsBitwiseIdenticalForEveryNumberOfThreads) {
  const int default_threads = n_threads();
  for (const VolumeMesh& mesh :
       {disturbed_box(BoxCells::mixed, 8), with_sliding_boundary(tube(8, 0.6), {}, 0.02)}) {
    std::vector<VolumeMesh> results;
    for (const int threads : {1, 3}) {
      set_n_threads(threads);
      results.push_back(mesh);
      auto made = test::short_method<3>(GetParam(), "3");
      smooth(results.back(), made);
      EXPECT_EQ(results.back().copied_coordinates(), results.front().copied_coordinates())
          << threads;
    }
  }
  set_n_threads(default_threads);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, SlidingBoundary, testing::ValuesIn(methods_supporting<3>(true)),
                         test::test_name);

TEST(SlidingBoundaries, HaveTheBordersOfLabelsAsFeatures) {
  const VolumeMesh plain = box_mesh(4, 4, 4, BoxCells::hexahedra);
  MeshLabels labels;
  const auto& facets = plain.topology().boundary_facets();
  for (std::size_t f = 0; f < facets.size(); ++f)  // one half of the bottom
    if (std::all_of(facets[f].begin(), facets[f].end(), [&](NodeIndex i) {
          return plain.coordinates()[i].z() == 0.0 && plain.coordinates()[i].x() <= 2.0;
        })) {
      labels.facets.append(facets[f]);
      labels.facet_tags.push_back(9);
    }
  const VolumeMesh mesh = with_sliding_boundary(
      VolumeMesh(std::make_shared<const Topology>(3, plain.n_nodes(), plain.topology().cells(),
                                                  std::nullopt, labels),
                 plain.copied_coordinates()));
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    const Point<3>& p = mesh.coordinates()[i];
    if (p.z() != 0.0 || p.x() != 2.0) continue;
    const bool is_end = p.y() == 0.0 || p.y() == 4.0;
    EXPECT_EQ(mesh.constraints()->classifications()[i].kind,
              is_end ? GeometricClassification::corner : GeometricClassification::line);
  }
}

TEST(SlidingBoundaries, NeedADistanceAboveZero) {
  for (const double distance : {0.0, -1.0, std::nan("")})
    EXPECT_THROW(with_sliding_boundary(box_mesh(2, 2, 2, BoxCells::hexahedra), {}, distance),
                 InputError);
}

TEST(SlidingBoundaries, AreRefusedByMethodsWithoutConstraints) {
  std::set<std::string> taken;
  for (const auto& info : method_catalogue()) {
    VolumeMesh mesh = with_sliding_boundary(box_mesh(3, 3, 3, BoxCells::hexahedra));
    auto made = make_method<3>(info.name);
    try {
      smooth(mesh, made);
      taken.insert(info.name);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(),
                  testing::HasSubstr("cannot keep nodes on the boundary or on interfaces; "
                                     "fix them, or use one of getme, getme-qgamma"));
    }
  }
  EXPECT_THAT(taken, testing::ElementsAreArray(methods_supporting<3>(true)));
  EXPECT_THAT(taken, testing::IsSupersetOf({"getme", "laplace", "smart-laplace"}));
}

}  // namespace
}  // namespace smoothfem
