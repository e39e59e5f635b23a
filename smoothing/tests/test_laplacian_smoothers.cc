// SPDX-License-Identifier: GPL-3.0-or-later
/// One iteration of each Laplacian smoother, against its formula written without the library.
#include <gtest/gtest.h>

#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/tests/planar_meshes.h"

namespace smoothfem {
namespace {

constexpr double round_off = 1e-14;

/// Returns the mesh after the iteration, also if the initial one is the better result.
PlanarMesh after_one_iteration(PlanarMesh mesh, const std::string& name) {
  auto method = make_method<2>(name);
  method.set("max_iterations", "1");
  PlanarMesh last = mesh;
  smooth(mesh, method, [&](const IterationRecord&, const PlanarMesh& seen) { last = seen; });
  return last;
}

/// Returns 3 x 3 unit squares, whose four inner nodes (5, 6, 9 and 10) are moved.
PlanarMesh moved_squares() {
  PlanarMesh mesh = test::grid_mesh(3, test::GridCells::quadrilaterals);
  mesh.coordinates()[5] += Point<2>(0.2, -0.1);
  mesh.coordinates()[6] += Point<2>(-0.1, 0.3);
  mesh.coordinates()[9] += Point<2>(0.1, 0.25);
  mesh.coordinates()[10] += Point<2>(0.15, -0.2);
  return mesh;
}

TEST(LaplacianSmoothers, LaplaceMovesEachNodeToTheMeanOfItsNeighbours) {
  const PlanarMesh mesh = moved_squares();
  auto x = mesh.copied_coordinates();
  for (const std::size_t i : {5, 6, 9, 10}) x[i] = (x[i - 4] + x[i - 1] + x[i + 1] + x[i + 4]) / 4;
  const PlanarMesh smoothed = after_one_iteration(mesh, "laplace");
  for (std::size_t i = 0; i < x.size(); ++i)
    EXPECT_LT((smoothed.coordinates()[i] - x[i]).norm(), round_off) << i;
}

TEST(LaplacianSmoothers, WeightedLaplaceMovesEachNodeToTheWeightedCentroids) {
  const PlanarMesh mesh = moved_squares();
  auto x = mesh.copied_coordinates();
  for (const std::size_t i : {5, 6, 9, 10}) {
    Point<2> sum = Point<2>::Zero();
    double areas = 0.0;
    for (const std::size_t corner : {i - 5, i - 4, i - 1, i}) {  // lower left nodes of its cells
      const Point<2>&a = x[corner], &b = x[corner + 1], &c = x[corner + 5], &d = x[corner + 4];
      const Point<2> one = c - a, two = d - b;
      const double area = 0.5 * (one.x() * two.y() - one.y() * two.x());
      sum += area * (a + b + c + d) / 4;
      areas += area;
    }
    x[i] = sum / areas;
  }
  const PlanarMesh smoothed = after_one_iteration(mesh, "weighted-laplace");
  for (std::size_t i = 0; i < x.size(); ++i)
    EXPECT_LT((smoothed.coordinates()[i] - x[i]).norm(), round_off) << i;
}

/// Returns the mean ratio of a triangle by its edge lengths (thesis, Section 3.1).
double mean_ratio(const Point<2>& a, const Point<2>& b, const Point<2>& c) {
  const Point<2> u = b - a, v = c - a;
  const double twice_area = u.x() * v.y() - u.y() * v.x();
  return 2.0 * std::sqrt(3.0) * twice_area /
         (u.squaredNorm() + v.squaredNorm() + (c - b).squaredNorm());
}

/// Triangles around one free node, which is near the mean of its neighbours: some movements raise
/// the mean quality a little, others lower it.
TEST(LaplacianSmoothers, SmartLaplaceMovesANodeOnlyIfTheMeanQualityRises) {
  test::Random random(5);
  int n_moved = 0, n_kept = 0;
  for (int star = 0; star < 200; ++star) {
    const NodeIndex n = 5 + star % 4;
    std::vector<Point<2>> x(1 + n);
    test::Cells cells;
    Point<2> mean = Point<2>::Zero();
    for (NodeIndex k = 0; k < n; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + 0.3 * random()) / n;
      x[1 + k] = (1.0 + 0.3 * random()) * Point<2>(std::cos(angle), std::sin(angle));
      mean += x[1 + k] / n;
      cells.push_back({0, 1 + k, 1 + (k + 1) % n});
    }
    x[0] = mean + 0.02 * Point<2>(random(), random());
    double gain = 0.0;
    for (NodeIndex k = 0; k < n; ++k) {
      const Point<2>&a = x[1 + k], &b = x[1 + (k + 1) % n];
      gain += mean_ratio(mean, a, b) - mean_ratio(x[0], a, b);
    }
    if (std::abs(gain) < 1e-9) continue;  // round-off decides
    (gain > 0.0 ? n_moved : n_kept) += 1;
    const PlanarMesh smoothed = after_one_iteration(test::make_mesh(x, cells), "smart-laplace");
    EXPECT_LT((smoothed.coordinates()[0] - (gain > 0.0 ? mean : x[0])).norm(), round_off) << star;
  }
  EXPECT_GT(n_moved, 20);
  EXPECT_GT(n_kept, 20);
}

}  // namespace
}  // namespace smoothfem
