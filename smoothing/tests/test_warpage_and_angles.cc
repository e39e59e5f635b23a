// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "smoothing/quality/dihedral_angles.h"
#include "smoothing/quality/warpage.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using Quad = std::array<Vector3<double>, 4>;

double warpage_of(const Quad& p) {
  return face_warpage(std::span<const Vector3<double>, 4>(p));
}

/// The unit square with one node lifted. Opposite normals are (-h, -h, 1) and (0, 0, 1) at nodes 2
/// and 0, (0, -h, 1) and (-h, 0, 1) at nodes 1 and 3.
TEST(Warpage, HandComputed) {
  for (const double h : {0.0, 0.1, 0.5, 1.0, 3.0}) {
    const double first = 1.0 / std::sqrt(1.0 + 2.0 * h * h), second = 1.0 / (1.0 + h * h);
    EXPECT_NEAR(warpage_of({{{0, 0, 0}, {1, 0, 0}, {1, 1, h}, {0, 1, 0}}}),
                1.0 - std::pow(std::min(first, second), 3), 1e-15)
        << h;
  }
}

TEST(Warpage, FoldedFacesReachTwo) {
  EXPECT_DOUBLE_EQ(warpage_of({{{0, 0, 0}, {1, 0, 0}, {0.2, 0.2, 0}, {0, 1, 0}}}), 2.0);
}

TEST(Warpage, DegenerateNormalsGiveOneAndNeverANaN) {
  EXPECT_EQ(warpage_of({}), 1.0);
  EXPECT_EQ(warpage_of({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}}), 1.0);
  EXPECT_EQ(warpage_of({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}}}), 1.0);
}

TEST(Warpage, DoesNotDependOnFirstNodeDirectionAndSize) {
  const Quad p{{{0, 0, 0.1}, {1.2, 0, -0.2}, {1, 1, 0.3}, {-0.1, 0.9, 0}}};
  const double expected = warpage_of(p);
  EXPECT_NEAR(warpage_of({p[1], p[2], p[3], p[0]}), expected, 1e-15);
  EXPECT_NEAR(warpage_of({p[3], p[2], p[1], p[0]}), expected, 1e-15);
  Quad large = p;
  for (auto& point : large) point = 1e6 * point;
  EXPECT_NEAR(warpage_of(large), expected, 1e-14);
}

TEST(Warpage, LanesAreBitwiseIdenticalToSingleCells) {
  test::Random random(3);
  std::array<std::array<Vector3<double>, 8>, n_lanes> cells;
  std::array<Vector3<Lanes>, 8> together;
  for (std::size_t k = 0; k < 8; ++k)
    for (std::size_t i = 0; i < n_lanes; ++i) {
      cells[i][k] = {random(), random(), i == 2 ? 0.0 : random()};  // one cell is degenerate
      if (i == 3) cells[i][k] = {0.0, 0.0, 0.0};
      together[k].x[i] = cells[i][k].x;
      together[k].y[i] = cells[i][k].y;
      together[k].z[i] = cells[i][k].z;
    }
  const Lanes warpages = element_warpage(std::span<const Vector3<Lanes>, 8>(together));
  for (std::size_t i = 0; i < n_lanes; ++i)
    EXPECT_EQ(warpages[i], element_warpage(std::span<const Vector3<double>, 8>(cells[i])));
  EXPECT_EQ(warpages[3], 1.0);
}

TEST(Warpage, MeshesCountEveryFaceOnce) {
  const MeshWarpage box = mesh_warpage(test::box_mesh(2, 3, 4, test::BoxCells::hexahedra));
  EXPECT_EQ(box.n_faces, 3u * 12 + 4u * 8 + 5u * 6);
  EXPECT_EQ(box.max, 0.0);
  VolumeMesh two = test::box_mesh(2, 1, 1, test::BoxCells::hexahedra);
  two.coordinates()[1].x() += 0.5;  // on the edge of two faces along x, and of the inner face
  const double inner = 1.0 - std::pow(1.0 / (1.0 + 0.25), 3);
  const MeshWarpage warpage = mesh_warpage(two);
  EXPECT_EQ(warpage.n_faces, 11u);
  EXPECT_NEAR(warpage.max, inner, 1e-15);
  EXPECT_NEAR(warpage.mean, inner / 11.0, 1e-15);
  EXPECT_EQ(mesh_warpage(test::box_mesh(1, 1, 1, test::BoxCells::tetrahedra)).n_faces, 0u);
}

TEST(Angles, OfRegularCells) {
  using std::numbers::sqrt2, std::numbers::sqrt3;
  const double to_degrees = 180.0 / std::numbers::pi;
  const VolumeMesh tetrahedron = test::make_volume_mesh(
      {{0, 0, 0}, {1, 0, 0}, {0.5, 0.5 * sqrt3, 0}, {0.5, sqrt3 / 6.0, std::sqrt(2.0 / 3.0)}},
      test::rows_of({{0, 1, 2, 3}}));
  EXPECT_NEAR(angle_range(tetrahedron).min, to_degrees * std::acos(1.0 / 3.0), 1e-12);
  EXPECT_NEAR(angle_range(tetrahedron).max, to_degrees * std::acos(1.0 / 3.0), 1e-12);
  const VolumeMesh pyramid =
      test::make_volume_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0.5 * sqrt2}},
                             test::rows_of({{0, 1, 2, 3, 4}}));
  EXPECT_NEAR(angle_range(pyramid).min, to_degrees * std::atan(sqrt2), 1e-12);
  EXPECT_NEAR(angle_range(pyramid).max, to_degrees * std::acos(-1.0 / 3.0), 1e-12);
  const VolumeMesh prism = test::make_volume_mesh(
      {{0, 0, 0}, {1, 0, 0}, {0.5, 0.5 * sqrt3, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, 0.5 * sqrt3, 1}},
      test::rows_of({{0, 1, 2, 3, 4, 5}}));
  EXPECT_NEAR(angle_range(prism).min, 60.0, 1e-12);
  EXPECT_NEAR(angle_range(prism).max, 90.0, 1e-12);
  const AngleRange box = angle_range(test::box_mesh(2, 2, 2, test::BoxCells::hexahedra));
  EXPECT_NEAR(box.min, 90.0, 1e-12);
  EXPECT_NEAR(box.max, 90.0, 1e-12);
}

TEST(Angles, OfPlanarCellsAndReentrantOnes) {
  const AngleRange grid = angle_range(test::grid_mesh(2, test::GridCells::triangles));
  EXPECT_NEAR(grid.min, 45.0, 1e-12);
  EXPECT_NEAR(grid.max, 90.0, 1e-12);
  const PlanarMesh arrow = test::make_mesh({{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}}, {{0, 1, 2, 3}});
  EXPECT_NEAR(angle_range(arrow).max, 360.0 - 180.0 / std::numbers::pi * std::acos(-0.6), 1e-12);
  VolumeMesh inverted = test::make_volume_mesh({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                               test::rows_of({{0, 1, 2, 3}}));
  EXPECT_GT(angle_range(inverted).min, 180.0);
}

}  // namespace
}  // namespace smoothfem
