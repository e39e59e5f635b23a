// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "meshes/io/mesh_view.h"
#include "meshes/refinement/split_cells.h"
#include "smoothing/geometry/cell_size.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using testing::ElementsAre;

/// Expects that parts are valid, fill the mesh and fit together, and that each boundary facet has
/// four parts.
template <int dim>
void expect_split(const Mesh<dim>& mesh, std::size_t n_parts, double size) {
  const Mesh<dim> split = with_split_cells(mesh);
  EXPECT_EQ(split.n_cells(), n_parts);
  EXPECT_EQ(mesh_quality(split).n_invalid, 0u);
  double sum = 0.0;
  for (CellIndex c = 0; c < split.n_cells(); ++c) sum += signed_cell_size(split, c);
  EXPECT_NEAR(sum, size, 1e-12 * size);
  EXPECT_EQ(split.topology().boundary_facets().size(),
            (dim == 2 ? 2 : 4) * mesh.topology().boundary_facets().size());
  for (std::size_t i = 0; i < mesh.n_nodes(); ++i)
    EXPECT_EQ(split.coordinates()[i], mesh.coordinates()[i]);
}

TEST(SplitCells, OfATriangleMatchHandComputation) {
  const PlanarMesh mesh = test::make_mesh({{0, 0}, {2, 0}, {0, 4}}, {{0, 1, 2}});
  const PlanarMesh split = with_split_cells(mesh);
  std::vector<std::pair<double, double>> points;
  for (const auto& p : split.coordinates()) points.emplace_back(p[0], p[1]);
  EXPECT_THAT(points, ElementsAre(std::pair(0, 0), std::pair(2, 0), std::pair(0, 4),
                                  std::pair(1, 0), std::pair(0, 2), std::pair(1, 2)));
  EXPECT_THAT(split.topology().cell_nodes(3), ElementsAre(3, 5, 4));
}

TEST(SplitCells, OfASquareHaveItsMiddle) {
  const PlanarMesh mesh = test::make_mesh({{0, 0}, {2, 0}, {2, 2}, {0, 2}}, {{0, 1, 2, 3}});
  const PlanarMesh split = with_split_cells(mesh);
  EXPECT_EQ(split.n_nodes(), 9u);
  for (CellIndex c = 0; c < 4; ++c) {
    bool has_middle = false;
    for (const NodeIndex node : split.topology().cell_nodes(c))
      has_middle |= split.coordinates()[node] == Point<2>(1, 1);
    EXPECT_TRUE(has_middle) << c;
  }
}

/// 0.1 + 1.2 + 1.3 + 0.4 differs from the sum in the reverse order in the last bit.
TEST(SplitCells, HaveMeansInTheOrderOfNumbers) {
  const PlanarMesh mesh = test::make_mesh({{0.1, 0}, {1.2, 0}, {1.3, 1}, {0.4, 1}}, {{0, 1, 2, 3}});
  const std::vector<std::uint32_t> numbers{13, 12, 11, 10};
  const auto split = split_cells(mesh, numbers), plain = split_cells(mesh);
  ASSERT_EQ(split.means.size(), 5u);
  EXPECT_THAT(split.means[0], ElementsAre(1, 0));
  EXPECT_THAT(plain.means[0], ElementsAre(0, 1));
  const auto middle = [](const auto& of) {
    for (std::size_t i = 0; i < 5; ++i)
      if (of.means[i].size() == 4) return of.points[4 + i][0];
    return 0.0;
  };
  EXPECT_EQ(middle(split), (0.4 + 1.3 + 1.2 + 0.1) / 4.0);
  EXPECT_EQ(middle(plain), (0.1 + 1.2 + 1.3 + 0.4) / 4.0);
  EXPECT_NE(middle(split), middle(plain));
  EXPECT_THAT(split.origins, ElementsAre(0, 0, 0, 0));
}

TEST(SplitCells, FillTheMeshInThePlane) {
  PlanarMesh triangles = test::grid_mesh(4, test::GridCells::triangles);
  PlanarMesh squares = test::grid_mesh(4, test::GridCells::quadrilaterals);
  test::distort(triangles, 0.2, 1);
  test::distort(squares, 0.2, 1);
  expect_split(triangles, 4 * triangles.n_cells(), 16.0);
  expect_split(squares, 4 * squares.n_cells(), 16.0);
}

TEST(SplitCells, FillTheMeshInSpace) {
  using enum test::BoxCells;
  for (const auto kind : {tetrahedra, prisms, hexahedra}) {
    const VolumeMesh mesh = test::box_mesh(2, 3, 2, kind);
    expect_split(mesh, 8 * mesh.n_cells(), 12.0);
  }
  const VolumeMesh pyramid_mesh = test::box_mesh(2, 3, 2, pyramids);
  expect_split(pyramid_mesh, 10 * pyramid_mesh.n_cells(), 12.0);
  const VolumeMesh of_all = test::box_mesh(2, 2, 8, mixed);
  std::size_t n_parts = 0;
  for (CellIndex c = 0; c < of_all.n_cells(); ++c)
    n_parts += of_all.topology().cell_type(c) == ElementType::pyramid ? 10 : 8;
  expect_split(of_all, n_parts, 32.0);
}

/// A flat tetrahedron: the middles of 0-1 and 2-3 are 1 apart, those of the other opposite edges 2.
TEST(SplitCells, OfATetrahedronAreCutAlongTheShortestDiagonal) {
  const VolumeMesh mesh = test::make_volume_mesh({{-2, 0, 0}, {2, 0, 0}, {0, 2, 1}, {0, -2, 1}},
                                                 test::rows_of({{0, 1, 2, 3}}));
  const VolumeMesh split = with_split_cells(mesh);
  ASSERT_EQ(split.n_cells(), 8u);
  EXPECT_EQ(mesh_quality(split).n_invalid, 0u);
  for (CellIndex c = 4; c < 8; ++c) {
    const auto nodes = split.topology().cell_nodes(c);
    EXPECT_EQ(split.coordinates()[nodes[0]], Point<3>(0, 0, 0));
    EXPECT_EQ(split.coordinates()[nodes[1]], Point<3>(0, 0, 1));
  }
}

TEST(SplitCells, PartsInheritTags) {
  MeshLabels labels;
  labels.cell_tags = {7, 8};
  labels.facets.append(std::vector<NodeIndex>{0, 1});
  labels.facet_tags = {5};
  labels.names[{1, 5}] = "below";
  auto topology = std::make_shared<const Topology>(2, 4, test::rows_of({{0, 1, 2}, {0, 2, 3}}),
                                                   std::nullopt, labels);
  const PlanarMesh split = with_split_cells(PlanarMesh(topology, {{0, 0}, {2, 0}, {2, 2}, {0, 2}}));
  const MeshLabels& found = split.topology().labels();
  EXPECT_THAT(found.cell_tags, ElementsAre(7, 7, 7, 7, 8, 8, 8, 8));
  EXPECT_THAT(found.facet_tags, ElementsAre(5, 5));
  EXPECT_EQ(found.facets[0][1], found.facets[1][0]);
  EXPECT_EQ(split.coordinates()[found.facets[0][1]], Point<2>(1, 0));
  EXPECT_EQ(found.names, labels.names);
}

/// Node 4 in the middle is marked, node 2 on the boundary is not.
TEST(SplitCells, NodesThatStayDoSoInTheRefinedMesh) {
  const PlanarMesh mesh = test::make_mesh({{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}},
                                          {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}},
                                          std::vector{true, true, false, true, true});
  const PlanarMesh found = refined(mesh);
  for (NodeIndex i = 0; i < found.n_nodes(); ++i) {
    const Point<2> p = found.coordinates()[i];
    EXPECT_EQ(found.topology().is_fixed(i), p[0] == 0 || p[1] == 0 || (p[0] == 1 && p[1] == 1))
        << p.transpose();
  }
}

/// Node 2 is off the plane z = 5 by rounding.
TEST(SplitCells, StayInThePlaneOfTheMesh) {
  FileContent content;
  content.plane.emplace();
  content.plane->origin = {0, 0, 5};
  content.plane->initial = {{0, 0, 5}, {2, 0, 5}, {0, 2, 5.0000000000000009}};
  MeshLabels labels;
  labels.content = std::make_shared<const FileContent>(content);
  const PlanarMesh split = with_split_cells(PlanarMesh(
      std::make_shared<const Topology>(2, 3, test::rows_of({{0, 1, 2}}), std::nullopt, labels),
      {{0, 0}, {2, 0}, {0, 2}}));
  const MeshView view(split);
  EXPECT_EQ(view.point(2), content.plane->initial[2]);
  EXPECT_EQ(view.point(3), Point<3>(1, 0, 5));
}

TEST(SplitCells, LossesAreNamed) {
  FileContent content;
  content.node_fields = {{.name = "number"}, {.name = "pressure"}};
  content.node_roles["GlobalIds"] = "number";
  content.element_fields = {{.name = "material"}};
  content.tag_field = "material";
  content.others[0].nodes.append(std::array<NodeIndex, 1>{3});
  MeshLabels labels;
  EXPECT_THAT(losses_of_splitting(labels), ElementsAre());
  labels.content = std::make_shared<const FileContent>(content);
  EXPECT_THAT(
      losses_of_splitting(labels),
      ElementsAre("the field pressure", "elements that are neither cells nor labelled facets"));
}

TEST(SplitCells, RefusesPolygons) {
  EXPECT_THROW((void)with_split_cells(test::pentagon_mesh()), InputError);
}

}  // namespace
}  // namespace smoothfem
