// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/distortion/distort.h"

#include <cmath>
#include <cstring>

#include "meshes/distortion/counter_random.h"
#include "meshes/tests/mesh_tests.h"
#include "meshes/tests/reference_distortion.h"
#include "smoothing/base/parallel.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;

/// n x n squares, each cut into two triangles if requested.
PlanarMesh grid(NodeIndex n, bool triangles) {
  std::vector<Point<2>> x;
  for (NodeIndex j = 0; j <= n; ++j)
    for (NodeIndex i = 0; i <= n; ++i) x.emplace_back(i, j);
  CompressedRows<NodeIndex> cells;
  for (NodeIndex j = 0; j < n; ++j)
    for (NodeIndex i = 0; i < n; ++i) {
      const NodeIndex a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = c - 1;
      if (triangles) {
        cells.append(std::vector<NodeIndex>{a, b, c});
        cells.append(std::vector<NodeIndex>{a, c, d});
      } else {
        cells.append(std::vector<NodeIndex>{a, b, c, d});
      }
    }
  return PlanarMesh(std::make_shared<const Topology>(2, x.size(), std::move(cells)), x);
}

/// FNV-1a over the bytes of all coordinates.
std::uint64_t hash(const PlanarMesh& mesh) {
  std::uint64_t value = 0xcbf29ce484222325;
  for (const auto& point : mesh.coordinates())
    for (const double coordinate : {point.x(), point.y()}) {
      unsigned char bytes[sizeof coordinate];
      std::memcpy(bytes, &coordinate, sizeof coordinate);
      for (const unsigned char byte : bytes) value = (value ^ byte) * 0x100000001b3;
    }
  return value;
}

TEST(SplitMix64, MatchesTheReferenceImplementation) {
  SplitMix64 random(1234567);
  for (const std::uint64_t expected :
       {6457827717110365317u, 3203168211198807973u, 9817491932198370423u, 4593380528125082431u,
        16408922859458223821u})
    EXPECT_EQ(random.next(), expected);
}

TEST(SplitMix64, UniformNumbersFillTheirRangeEvenly) {
  SplitMix64 random = counter_random(1, 2, 3);
  constexpr int n = 100000, n_bins = 10;
  int bins[n_bins] = {}, dice[7] = {};
  for (int i = 0; i < n; ++i) {
    const double u = random.uniform();
    ASSERT_TRUE(u >= 0.0 && u < 1.0);
    ++bins[static_cast<int>(u * n_bins)];
    ++dice[random.below(7)];
  }
  for (const int count : bins) EXPECT_NEAR(count, n / n_bins, 500);  // five standard deviations
  for (const int count : dice) EXPECT_NEAR(count, n / 7, 600);
}

/// Returns the high half of a product of 64-bit numbers, computed by halves of 32 bits with
/// carries.
std::uint64_t high_half(std::uint64_t x, std::uint64_t y) {
  const std::uint64_t mask = 0xffffffff;
  const std::uint64_t low = (x & mask) * (y & mask);
  const std::uint64_t middle = (x >> 32) * (y & mask) + (low >> 32);
  const std::uint64_t other_middle = (x & mask) * (y >> 32) + (middle & mask);
  return (x >> 32) * (y >> 32) + (middle >> 32) + (other_middle >> 32);
}

TEST(SplitMix64, NumbersBelowALimitAreFractionsOfIt) {
  SplitMix64 random(42), same(42);
  for (const std::uint64_t n : {std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{7},
                                std::uint64_t{1} << 32, ~std::uint64_t{0}})
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(random.below(n), high_half(same.next(), n));
}

TEST(CounterRandom, MixesSeedStreamAndItemOneAfterTheOther) {
  SplitMix64 random = counter_random(42, 7, 3);
  std::uint64_t state = first_number(first_number(first_number(42) + 7) + 3);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(random.next(), next_number(state));
}

TEST(CounterRandom, DependsOnEachOfItsArguments) {
  const std::uint64_t first = counter_random(1, 2, 3).next();
  EXPECT_EQ(counter_random(1, 2, 3).next(), first);
  for (const auto& other : {counter_random(2, 2, 3), counter_random(1, 3, 3),
                            counter_random(1, 2, 4), counter_random(3, 2, 1)})
    EXPECT_NE(SplitMix64(other).next(), first);
}

class Distort : public ::testing::TestWithParam<bool> {};

TEST_P(Distort, MeetsTheTargetWithAValidMeshAndFixedBoundary) {
  const PlanarMesh original = grid(20, GetParam());
  for (const double target : {0.7, 0.5, GetParam() ? 0.3699 : 0.4180}) {
    PlanarMesh mesh = original;
    const DistortionResult result = distort(mesh, {.target_q_mean = target});
    const MeshQuality quality = mesh_quality(mesh);
    EXPECT_NEAR(quality.q_mean, target, 1e-4);
    EXPECT_EQ(quality.q_mean, result.q_mean);
    EXPECT_EQ(quality.n_invalid, 0u);
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
      if (!mesh.topology().is_fixed(i)) continue;
      EXPECT_EQ(mesh.copied_coordinates()[i], original.copied_coordinates()[i]);
    }
  }
}

TEST_P(Distort, KeepsToTheBallOfItsRadius) {
  const PlanarMesh original = grid(20, GetParam());
  PlanarMesh mesh = original;
  const double radius = distort(mesh, {.target_q_mean = 0.6}).radius;
  const double edge_length = GetParam() ? (4.0 + 2.0 * std::sqrt(2.0)) / 6.0 : 1.0;
  double farthest = 0.0;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    farthest = std::max(farthest, (mesh.coordinates()[i] - original.coordinates()[i]).norm());
  EXPECT_LE(farthest, radius * edge_length * (1.0 + 1e-12));
  EXPECT_GE(farthest, 0.9 * radius * edge_length);
}

TEST_P(Distort, IsBitwiseReproducibleAndDependsOnTheSeed) {
  const auto hash_for = [](std::uint64_t seed, double target) {
    PlanarMesh mesh = grid(20, GetParam());
    distort(mesh, {.target_q_mean = target, .seed = seed});
    return hash(mesh);
  };
  EXPECT_EQ(hash_for(1, 0.5), hash_for(1, 0.5));
  EXPECT_NE(hash_for(1, 0.5), hash_for(2, 0.5));
  EXPECT_NE(hash_for(1, 0.5), hash_for(1, 0.6));
}

INSTANTIATE_TEST_SUITE_P(Grids, Distort, ::testing::Bool(), [](const auto& info) {
  return info.param ? "triangles" : "quadrilaterals";
});

TEST(DistortOnAnyMachine, IsBitwiseIdenticalToASecondImplementation) {
  const PlanarMesh original = grid(12, true);
  for (const std::uint64_t seed : {1, 42})
    for (const int n_sweeps : {1, 3}) {
      PlanarMesh mesh = original;
      distort_within(mesh, 0.8, {.seed = seed, .n_candidates = 7, .n_sweeps = n_sweeps});
      EXPECT_EQ(mesh.copied_coordinates(), reference_distortion(original, 0.8, seed, 7, n_sweeps));
    }
}

TEST(DistortOnAnyMachine, RandomStepsAreBitwiseIdenticalToASecondImplementation) {
  const PlanarMesh original = grid(12, true);
  for (const std::uint64_t seed : {1, 42})
    for (const int n_sweeps : {1, 3}) {
      PlanarMesh mesh = original;
      distort_within(mesh, 0.8,
                     {.seed = seed, .kind = DistortionKind::random_steps, .n_sweeps = n_sweeps});
      const auto again = reference_random_steps(original, 0.8, seed, n_sweeps);
      for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
        ASSERT_EQ(mesh.copied_coordinates()[i], again[i]) << i;
    }
}

/// Checks four free nodes, bit by bit, against values from another machine.
TEST(DistortOnAnyMachine, IsBitwiseIdenticalToRecordedCoordinates) {
  const PlanarMesh original = grid(3, true);
  PlanarMesh mesh = original;
  distort_within(mesh, 0.5, {.seed = 42, .n_candidates = 4});
  EXPECT_EQ(mesh.copied_coordinates(), reference_distortion(original, 0.5, 42, 4, 1));
  std::vector<Point<2>> free;
  for (const NodeIndex node : mesh.topology().free_nodes())
    free.push_back(mesh.copied_coordinates()[node]);
  EXPECT_EQ(free, (std::vector<Point<2>>{{0x1.d42123b873d9ep-2, 0x1.fd3426ef3f135p-1},
                                         {0x1.9d8f895dcce24p+0, 0x1.37df09294b4fcp-1},
                                         {0x1.82e5e3d9d5688p+0, 0x1.04e47a8f132fcp+1},
                                         {0x1.8f6036546969ep+0, 0x1.04fde787d60a9p+1}}));
}

/// Repeats the documented steps. The radius is found by bisection of a sixteenth of the largest
/// one, 4, in twelve steps. Nodes, from the first one on, move once more until the mean quality is
/// the target. All later nodes stay at the positions of that radius.
TEST(DistortOnAnyMachine, FindsThisRadius) {
  const PlanarMesh original = grid(12, true);
  PlanarMesh mesh = original;
  const DistortionResult result = distort(mesh, {.target_q_mean = 0.45, .seed = 42});
  EXPECT_EQ(result.radius, 12804 * 0x1p-14);
  const auto expected = reference_distortion(original, result.radius, 42, default_candidates(2), 1);
  const auto& free = mesh.topology().free_nodes();
  std::size_t n_nodes_moved_again = free.size();
  while (n_nodes_moved_again > 0 && mesh.coordinates()[free[n_nodes_moved_again - 1]] ==
                                        expected[free[n_nodes_moved_again - 1]])
    --n_nodes_moved_again;
  EXPECT_EQ(n_nodes_moved_again, 3u);
  EXPECT_NEAR(result.q_mean, 0.45, 1e-12);
}

TEST(RandomSteps, MeetTheTargetWithAValidMeshAndFixedBoundary) {
  for (const bool triangles : {true, false}) {
    const PlanarMesh original = grid(20, triangles);
    PlanarMesh mesh = original;
    distort(mesh, {.target_q_mean = 0.5, .kind = DistortionKind::random_steps, .n_sweeps = 10});
    const MeshQuality quality = mesh_quality(mesh);
    EXPECT_NEAR(quality.q_mean, 0.5, 1e-4);
    EXPECT_EQ(quality.n_invalid, 0u);
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
      if (!mesh.topology().is_fixed(i)) continue;
      EXPECT_EQ(mesh.copied_coordinates()[i], original.copied_coordinates()[i]);
    }
  }
}

/// Neighbours of a node that has moved far must follow it; with one step each they do not.
TEST(RandomSteps, MoveNeighboursTogether) {
  const auto correlation = [](const DistortionParameters& parameters) {
    const PlanarMesh original = grid(40, true);
    PlanarMesh mesh = original;
    distort(mesh, parameters);
    const Topology& topology = mesh.topology();
    double of_neighbours = 0.0, of_nodes = 0.0, n_pairs = 0.0, n_nodes = 0.0;
    std::vector<Point<2>> d;
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      d.push_back(mesh.coordinates()[i] - original.coordinates()[i]);
    for (const NodeIndex i : topology.free_nodes()) {
      of_nodes += d[i].squaredNorm();
      ++n_nodes;
      for (const NodeIndex j : topology.node_neighbours(i)) {
        if (topology.is_fixed(j)) continue;
        of_neighbours += d[i].dot(d[j]);
        ++n_pairs;
      }
    }
    return (of_neighbours / n_pairs) / (of_nodes / n_nodes);
  };
  EXPECT_GT(
      correlation({.target_q_mean = 0.45, .kind = DistortionKind::random_steps, .n_sweeps = 10}),
      0.1);
  EXPECT_LT(correlation({.target_q_mean = 0.45}), 0.05);
}

TEST(Distort, LeavesNoCellBelowTheSmallestQuality) {
  for (const DistortionKind kind :
       {DistortionKind::worst_candidate, DistortionKind::random_steps}) {
    PlanarMesh free = grid(20, true), bounded = grid(20, true);
    const DistortionParameters parameters{
        .target_q_mean = 0.5, .kind = kind, .n_sweeps = 3, .min_quality = 0.1};
    distort(bounded, parameters);
    EXPECT_GE(mesh_quality(bounded).q_min, 0.1);
    EXPECT_NEAR(mesh_quality(bounded).q_mean, 0.5, 1e-4);
    distort(free, {.target_q_mean = 0.5, .kind = kind, .n_sweeps = 3});
    EXPECT_LT(mesh_quality(free).q_min, 0.1);
  }
}

/// Cells of the grid have a mean ratio of .866. This is below .9 from the beginning, so that they
/// must not become worse.
TEST(Distort, DoesNotWorsenCellsBelowTheSmallestQuality) {
  PlanarMesh mesh = grid(6, true);
  const double before = mesh_quality(mesh).q_min;
  distort_within(mesh, 0.8, {.kind = DistortionKind::random_steps, .min_quality = 0.9});
  EXPECT_GE(mesh_quality(mesh).q_min, before);
}

TEST(DistortErrors, ReportTheRangeThatCanBeReached) {
  const PlanarMesh original = grid(6, false);
  PlanarMesh mesh = original;
  EXPECT_THAT(input_error_of([&] { distort(mesh, {.target_q_mean = 0.01}); }),
              HasSubstr("cannot reach the mean quality 0.010000; on this mesh it reaches values"));
  EXPECT_EQ(mesh.copied_coordinates(), original.copied_coordinates());
  mesh = grid(6, true);
  EXPECT_THAT(input_error_of([&] { distort(mesh, {.target_q_mean = 0.95}); }),
              HasSubstr("because the mesh itself has 0.866025"));
  EXPECT_THAT(input_error_of([&] { distort(mesh, {.target_q_mean = 1.5}); }),
              HasSubstr("1.500000 is not between 0 and 1"));
  EXPECT_THAT(input_error_of([&] { distort(mesh, {.n_candidates = 0}); }), HasSubstr("not 0"));
  EXPECT_THAT(input_error_of([&] { distort(mesh, {.n_sweeps = 0}); }), HasSubstr("not 0"));
  EXPECT_THAT(input_error_of([&] { distort(mesh, {.min_quality = 1.0}); }),
              HasSubstr("least quality 1.000000 is not between 0 and 1"));
  EXPECT_THAT(input_error_of([&] { distort(mesh, {.tolerance = 0.0}); }), HasSubstr("positive"));
}

TEST(DistortErrors, RefusesInvalidMeshes) {
  PlanarMesh mesh = grid(6, false);
  mesh.coordinates()[24] = {10, 10};
  EXPECT_THAT(input_error_of([&] { distort(mesh, {}); }), HasSubstr("cells are invalid"));
}

TEST(DistortErrors, AMeshWithoutFreeNodesKeepsItsQuality) {
  PlanarMesh mesh = grid(1, true);
  EXPECT_THAT(input_error_of([&] { distort(mesh, {}); }), HasSubstr("cannot reach"));
}

TEST(Distort, DoesNotDependOnTheNumberOfThreads) {
  for (const DistortionKind kind :
       {DistortionKind::worst_candidate, DistortionKind::random_steps}) {
    const DistortionParameters parameters{.kind = kind, .n_sweeps = 2};
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 5}) {
      set_n_threads(threads);
      PlanarMesh mesh = grid(40, true);
      distort_within(mesh, 0.8, parameters);
      hashes.push_back(hash(mesh));
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
  }
}

}  // namespace
}  // namespace smoothfem
