// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tests/domain_tests.h"
#include "meshes/tools/grid_region.h"
#include "meshes/tools/quad_split.h"
#include "meshes/tools/quadrilateral_region.h"

namespace smoothfem {
namespace {

std::size_t n_cells_with(const PlanarMesh& mesh, std::size_t n_nodes) {
  std::size_t n = 0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    n += mesh.topology().cell_nodes(c).size() == n_nodes;
  return n;
}

void expect_counts(const PlanarMesh& mesh, std::size_t n_nodes, std::size_t n_triangles,
                   std::size_t n_quadrilaterals) {
  expect_valid(mesh);
  EXPECT_EQ(mesh.n_nodes(), n_nodes);
  EXPECT_EQ(n_cells_with(mesh, 3), n_triangles);
  EXPECT_EQ(n_cells_with(mesh, 4), n_quadrilaterals);
  EXPECT_EQ(mesh.n_cells(), n_triangles + n_quadrilaterals);
  EXPECT_EQ(euler_characteristic(mesh), 1 - 9) << "nine holes";
}

TEST(RandomPlanar, TrianglesHaveTheCountsAndQualityOfTheThesis) {
  for (const double seed : test::short_or_long({2}, {1, 2, 7})) {
    const PlanarMesh mesh = mesh_of_domain<2>(
        "random-planar", {.elements = "triangles", .seed = static_cast<std::uint64_t>(seed)});
    expect_counts(mesh, 1838, 3060, 0);
    EXPECT_NEAR(mesh_quality(mesh).q_mean, 0.8193, 5e-5);
  }
}

TEST(RandomPlanar, QuadrilateralsHaveTheCountsOfTheThesis) {
  const PlanarMesh mesh = mesh_of_domain<2>("random-planar", {.elements = "quadrilaterals"});
  expect_counts(mesh, 6562, 0, 6111);
  EXPECT_GT(mesh_quality(mesh).q_mean, 0.95);
}

TEST(RandomPlanar, MixedMeshHasTheCountsOfTheThesis) {
  const PlanarMesh mesh = mesh_of_domain<2>("random-planar", {.elements = "mixed"});
  expect_counts(mesh, 8152, 8732, 3368);
  EXPECT_NEAR(mesh_quality(mesh).q_mean, 0.8801, 0.005);
}

TEST(RandomPlanar, IsTheSameForTheSameSeedOnly) {
  for (const std::string elements : {"triangles", "mixed"}) {
    const auto mesh = [&](std::uint64_t seed) {
      return mesh_of_domain<2>("random-planar", {elements, 1.5, seed});
    };
    expect_same_mesh(mesh(3), mesh(3));
    EXPECT_FALSE(mesh(3).topology().cells() == mesh(4).topology().cells());
  }
}

TEST(RandomPlanar, CanBeCoarser) {
  for (const std::string elements : {"triangles", "quadrilaterals", "mixed"})
    for (const double scale : {1.3, 1.7, 2.0}) {
      const PlanarMesh mesh = mesh_of_domain<2>("random-planar", {elements, scale, 1});
      expect_valid(mesh);
      const double whole = elements == "triangles"        ? 3060
                           : elements == "quadrilaterals" ? 6111
                                                          : 12100;
      EXPECT_NEAR(static_cast<double>(mesh.n_cells()) / (whole / (scale * scale)), 1.0, 0.4);
    }
  expect_edge_scales("random-planar", 2);
}

const Polygons square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

TEST(GridRegion, RemovesSquaresWithoutChangingTheTopology) {
  GridRegion region(square, 1.0 / 12.3);
  const std::size_t n = region.n_cells(), edges = region.n_boundary_edges();
  EXPECT_EQ(n, 11u * 11u);  // twelve lines, the first one half a spacing from the side
  EXPECT_EQ(edges, 44u);
  EXPECT_EQ(region.remove(5, 3, 1), 5u);
  EXPECT_EQ(region.n_boundary_edges(), edges + 10u);
  EXPECT_EQ(region.remove(4, 2, 1), 4u);
  const PlanarMesh mesh = mesh_of(region.cells(), "region");
  EXPECT_EQ(mesh.n_cells(), n - 9u);
  EXPECT_EQ(mesh.topology().boundary_facets().size(), edges + 10u);
  EXPECT_EQ(euler_characteristic(mesh), 1);
  // No square touches another at a corner only: otherwise four boundary edges would meet there.
  std::vector<int> n_boundary_edges(mesh.n_nodes(), 0);
  for (const NodeIndex node : mesh.topology().boundary_facets().entries()) ++n_boundary_edges[node];
  EXPECT_EQ(*std::max_element(n_boundary_edges.begin(), n_boundary_edges.end()), 2);
}

TEST(QuadrilateralRegion, MeetsTheCountOrIsOneShort) {
  Polygons polygons(1);
  for (int side = 0; side < 4; ++side)
    for (int i = 0; i < 10; ++i) {
      const Point<2> from = square[0][static_cast<std::size_t>(side)];
      const Point<2> to = square[0][static_cast<std::size_t>((side + 1) % 4)];
      polygons[0].push_back(from + 0.1 * i * (to - from));
    }
  for (const std::size_t n : {120u, 121u, 122u, 140u}) {
    const PlanarMesh mesh = mesh_of(mesh_with_n_quadrilaterals(polygons, n), "square");
    EXPECT_EQ(mesh.n_cells(), n / 2 * 2);  // 40 edges: even numbers only
    EXPECT_EQ(mesh.topology().boundary_facets().size(), 40u);
    EXPECT_EQ(n_cells_with(mesh, 4), mesh.n_cells());
  }
}

TEST(QuadSplit, CutsTheWorstQuadrilaterals) {
  PlanarCells mesh;
  mesh.coordinates = {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 3}};
  mesh.cells.append(std::vector<NodeIndex>{0, 1, 4, 3});
  mesh.cells.append(std::vector<NodeIndex>{1, 2, 5, 4});
  cut_worst_quadrilaterals(mesh, 1);
  ASSERT_EQ(mesh.cells.size(), 3u);
  EXPECT_EQ(mesh.cells[0].size(), 4u);
  EXPECT_EQ(std::vector<NodeIndex>(mesh.cells[1].begin(), mesh.cells[1].end()),
            (std::vector<NodeIndex>{2, 5, 4}))
      << "at the shorter diagonal";
}

}  // namespace
}  // namespace smoothfem
