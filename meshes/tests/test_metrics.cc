// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "meshes/metrics/metric_statistics.h"
#include "smoothing/quality/cell_targets.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<double> values(const std::string& name, const auto& mesh) {
  return metrics_named(name).at(0)->values(&mesh);
}

PlanarMesh polygon(const std::vector<Point<2>>& corners) {
  std::vector<NodeIndex> nodes;
  for (std::size_t k = 0; k < corners.size(); ++k) nodes.push_back(static_cast<NodeIndex>(k));
  return test::make_mesh(corners, {nodes});
}

/// Legs 1, hypotenuse sqrt(2): r = 1 - sqrt(2) / 2, R = sqrt(2) / 2.
TEST(Metrics, OfARightTriangleMatchHandComputation) {
  const double sqrt2 = std::numbers::sqrt2;
  const PlanarMesh mesh = polygon({{0, 0}, {1, 0}, {0, 1}});
  EXPECT_NEAR(values("edge_ratio", mesh).at(0), sqrt2, 1e-14);
  EXPECT_NEAR(values("radius_ratio", mesh).at(0), sqrt2 / (4.0 - 2.0 * sqrt2), 1e-14);
  EXPECT_NEAR(values("scaled_jacobian", mesh).at(0), std::sqrt(2.0 / 3.0), 1e-14);
  EXPECT_NEAR(values("min_angle", mesh).at(0), 45.0, 1e-12);
  EXPECT_NEAR(values("max_angle", mesh).at(0), 90.0, 1e-12);
}

TEST(Metrics, HaveTheirIdealInRegularCells) {
  const PlanarMesh triangle = polygon({{0, 0}, {1, 0}, {0.5, 0.5 * std::numbers::sqrt3}});
  const PlanarMesh square = polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  const VolumeMesh tetrahedron = test::make_volume_mesh(
      {{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}}, test::rows_of({{0, 1, 2, 3}}));
  const VolumeMesh cube = test::box_mesh(1, 1, 1, test::BoxCells::hexahedra);
  for (const Metric& metric : metric_catalogue())
    for (const MeshReference& mesh : {MeshReference(&triangle), MeshReference(&square),
                                      MeshReference(&tetrahedron), MeshReference(&cube)})
      for (const double value : metric.values(mesh)) {
        const ElementType type =
            std::visit([](const auto* m) { return m->topology().cell_type(0); }, mesh);
        const auto& types = metric.types;
        const bool is_supported = std::find(types.begin(), types.end(), type) != types.end();
        const bool has_value =
            is_supported && metric.name != "size_gradation" && !metric.compares_with_initial;
        EXPECT_EQ(std::isnan(value), !has_value) << metric.name;  // of one cell alone
        if (has_value && metric.ideal) {
          EXPECT_NEAR(value, *metric.ideal, 1e-13) << metric.name;
        }
      }
}

TEST(Metrics, CompareWithTheInitialCells) {
  const PlanarMesh thin = polygon({{0, 0}, {4, 0}, {0, 1}});
  const PlanarMesh wide = polygon({{0, 0}, {8, 0}, {0, 1}}),
                   turned = polygon({{0, 0}, {0, 1}, {4, 0}});
  const auto since = [&](const std::string& name, const PlanarMesh& now) {
    return values(name, with_targets(now, targets_of(thin, TargetKind::shape_and_size))).at(0);
  };
  // Twice as long along one edge: so the regular cell becomes a triangle of sides 1, 2 and sqrt(3).
  // Its area is sqrt(3) / 2, and its mean ratio 4 sqrt(3) area / (1 + 4 + 3).
  EXPECT_NEAR(since("initial_shape", thin), 1.0, 1e-14);
  EXPECT_NEAR(since("initial_shape", wide), 0.75, 1e-14);
  EXPECT_NEAR(since("initial_size", wide), 0.5, 1e-14);
  EXPECT_EQ(since("initial_size", turned), 0.0);
}

TEST(Metrics, QuantilesAreInterpolated) {
  const std::vector<double> four{1.0, 2.0, 4.0, 8.0};
  EXPECT_DOUBLE_EQ(quantile(four, 0.05), 1.15);
  EXPECT_DOUBLE_EQ(quantile(four, 0.5), 3.0);
  EXPECT_DOUBLE_EQ(quantile(four, 1.0), 8.0);
}

/// Two squares of sides 1 and 1, 3 and 1: areas 1 and 3.
TEST(Metrics, SizeGradationIsTheRatioOfNeighbours) {
  const PlanarMesh mesh = test::make_mesh({{0, 0}, {1, 0}, {4, 0}, {0, 1}, {1, 1}, {4, 1}},
                                          {{0, 1, 4, 3}, {1, 2, 5, 4}});
  EXPECT_THAT(values("size_gradation", mesh), ElementsAre(3.0, 3.0));
  EXPECT_THAT(values("size_gradation", polygon({{0, 0}, {1, 0}, {0, 1}})),
              ElementsAre(testing::IsNan()));
}

TEST(Metrics, RefusesUnknownNamesAndListsTheAvailableOnes) {
  try {
    metrics_named("shape, sheer");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'shear'?"));
    EXPECT_THAT(error.what(), HasSubstr("size_gradation"));
  }
  EXPECT_THROW(metrics_named("shape, shape"), InputError);
}

}  // namespace
}  // namespace smoothfem
