// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "smoothing/quality/layers.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

/// A mesh whose coordinate d is squeezed below 1, so that the first row of cells is thin.
template <int dim>
Mesh<dim> squeezed(Mesh<dim> mesh, int d) {
  for (auto& point : mesh.coordinates())
    point[d] = point[d] <= 1.0 ? 0.05 * point[d] : point[d] - 0.95;
  return mesh;
}

TEST(Layers, AspectIsOneForSquaresAndCubesAndTheRatioOfLengthToHeightOtherwise) {
  EXPECT_DOUBLE_EQ(cell_aspect(test::grid_mesh(2, test::GridCells::quadrilaterals), 0), 1.0);
  EXPECT_DOUBLE_EQ(cell_aspect(test::box_mesh(2, 2, 2, test::BoxCells::hexahedra), 0), 1.0);
  EXPECT_DOUBLE_EQ(cell_aspect(squeezed(test::grid_mesh(2, test::GridCells::quadrilaterals), 1), 0),
                   20.0);
  // A right triangle with legs 1 and 1: hypotenuse sqrt 2 above height 1 / sqrt 2.
  EXPECT_NEAR(cell_aspect(test::grid_mesh(2, test::GridCells::triangles), 0), 2.0, 1e-14);
}

TEST(Layers, AreThinCellsAlongTheBoundary) {
  const PlanarMesh plane = squeezed(test::grid_mesh(4, test::GridCells::quadrilaterals), 1);
  EXPECT_EQ(find_layers(plane).cells, (std::vector<CellIndex>{0, 1, 2, 3}));
  EXPECT_EQ(find_layers(plane).tags, (std::set<int>{0}));
  EXPECT_TRUE(find_layers(plane, {5}).cells.empty());  // no facet has this label
  for (const auto kind : {test::BoxCells::hexahedra, test::BoxCells::prisms}) {
    const VolumeMesh box = squeezed(test::box_mesh(2, 2, 3, kind), 2);
    EXPECT_EQ(find_layers(box).cells.size(), kind == test::BoxCells::prisms ? 8u : 4u);
  }
  EXPECT_EQ(
      find_layers(squeezed(test::box_mesh(2, 2, 3, test::BoxCells::tetrahedra), 2)).cells.size(),
      24u);
}

TEST(Layers, FewThinCellsOfADistortedMeshAreNone) {
  PlanarMesh mesh = test::grid_mesh(12, test::GridCells::quadrilaterals);
  for (auto& point : mesh.coordinates())  // thins two cells at the lower boundary
    if (point.y() == 1.0 && point.x() >= 4.0 && point.x() <= 6.0) point.y() = 0.05;
  EXPECT_GT(cell_aspect(mesh, 4), min_layer_aspect);
  EXPECT_TRUE(find_layers(mesh).cells.empty());
}

TEST(Layers, ThinCellsElsewhereAreNone) {
  // The thin row is in the middle: its short ends only are on the boundary.
  PlanarMesh mesh = test::grid_mesh(3, test::GridCells::quadrilaterals);
  for (auto& point : mesh.coordinates())
    point.y() = point.y() <= 1.0   ? point.y()
                : point.y() <= 2.0 ? 1.0 + 0.05 * (point.y() - 1.0)
                                   : 2.05;
  EXPECT_TRUE(find_layers(mesh).cells.empty());
}

}  // namespace
}  // namespace smoothfem
