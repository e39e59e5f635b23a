// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tests/domain_tests.h"

namespace smoothfem {
namespace {

std::size_t n_boundary_nodes(const VolumeMesh& mesh) {
  const auto& on_boundary = mesh.topology().on_boundary();
  return static_cast<std::size_t>(std::count(on_boundary.begin(), on_boundary.end(), true));
}

TEST(Sphere, HasTheNodesOfTheThesis) {
  const VolumeMesh mesh = mesh_of_domain<3>("sphere");
  expect_valid(mesh);
  EXPECT_EQ(mesh.n_nodes(), 258u + 346u);
  EXPECT_EQ(n_boundary_nodes(mesh), 258u);
  EXPECT_NEAR(static_cast<double>(mesh.n_cells()), 3108, 0.03 * 3108);
  EXPECT_EQ(euler_characteristic(mesh), 1);
  for (NodeIndex i = 0; i < 258; ++i) EXPECT_NEAR(mesh.copied_coordinates()[i].norm(), 1.0, 1e-14);
  EXPECT_GT(mesh_quality(mesh_of_domain<3>("sphere", {.seed = 2})).q_min, 0.0);
  expect_edge_scales("sphere", 1);
}

TEST(Prosthesis, HasTheNodesOfTheThesis) {
  const VolumeMesh mesh = mesh_of_domain<3>("prosthesis");
  expect_valid(mesh);
  EXPECT_NEAR(static_cast<double>(mesh.n_nodes()), 2669, 0.02 * 2669);
  EXPECT_NEAR(static_cast<double>(n_boundary_nodes(mesh)), 1228, 0.03 * 1228);
  EXPECT_NEAR(static_cast<double>(mesh.n_cells()), 13192, 0.05 * 13192);
  expect_edge_scales("prosthesis", 1);
}

TEST(Cubes, HaveTheirVolumeAndNodesInTheirCorners) {
  struct Expected {
    const char* name;
    double volume;
    std::size_t n_hexahedra;
    std::vector<Point<3>> corners;
  };
  for (const auto& [name, volume, n_hexahedra, corners] :
       {Expected{"cube", 1.0, 512u, {{0, 0, 0}, {1, 1, 1}, {1, 0, 1}}},
        Expected{"fichera", 7.0, 448u, {{0, 0, 0}, {-1, -1, -1}, {1, 0, 0}, {1, 1, -1}}}})
    for (const char* elements : {"tetrahedra", "hexahedra"}) {
      SCOPED_TRACE(std::string(name) + " of " + elements);
      const VolumeMesh mesh = mesh_of_domain<3>(name, {.elements = elements, .edge_scale = 4.0});
      expect_valid(mesh);
      EXPECT_EQ(euler_characteristic(mesh), 1);
      if (elements == std::string("hexahedra")) {
        EXPECT_EQ(mesh.n_cells(), n_hexahedra);
      }
      EXPECT_NEAR(volume_inside(mesh), volume, 1e-12 * volume);
      for (const Point<3>& corner : corners)
        EXPECT_TRUE(std::any_of(mesh.coordinates().begin(), mesh.coordinates().end(),
                                [&](const auto& p) { return (p - corner).norm() < 1e-12; }));
    }
  expect_edge_scales("cube", 8);
  expect_edge_scales("fichera", 8);
}

TEST(Axle, IsGradedAndHasItsGenus) {
  const VolumeMesh mesh = mesh_of_domain<3>("axle", {.edge_scale = test::is_long() ? 2.0 : 4.0});
  expect_valid(mesh);
  EXPECT_EQ(euler_characteristic(mesh), 1 - 17);
  double shortest = 1e9, longest = 0.0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto nodes = mesh.topology().cell_nodes(c);
    double sum = 0.0;
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < a; ++b)
        sum += (mesh.coordinates()[nodes[a]] - mesh.coordinates()[nodes[b]]).norm() / 6.0;
    shortest = std::min(shortest, sum);
    longest = std::max(longest, sum);
  }
  EXPECT_GT(longest / shortest, 20.0);
  expect_edge_scales("axle", 6);
}

TEST(Piston, IsAPistonAtEveryScale) {
  std::size_t before = 0;
  for (const double scale : test::short_or_long({12.0, 6.0}, {12.0, 6.0, 4.0})) {
    const VolumeMesh mesh = mesh_of_domain<3>("piston", {.edge_scale = scale});
    expect_valid(mesh);
    EXPECT_GT(mesh.n_cells(), before);
    before = mesh.n_cells();
    EXPECT_EQ(euler_characteristic(mesh), 1 - 2) << "the pin hole meets the hollow";
  }
  expect_edge_scales("piston", 12);
}

TEST(TetrahedralDomains, AreTheSameEveryTime) {
  const DomainParameters coarse{.edge_scale = test::is_long() ? 4.0 : 6.0};
  expect_same_mesh(mesh_of_domain<3>("piston", coarse), mesh_of_domain<3>("piston", coarse));
  if (!test::is_long()) return;
  expect_same_mesh(mesh_of_domain<3>("axle", coarse), mesh_of_domain<3>("axle", coarse));
  // These have one size only.
  for (const char* domain : {"sphere", "prosthesis"})
    expect_same_mesh(mesh_of_domain<3>(domain), mesh_of_domain<3>(domain));
}

}  // namespace
}  // namespace smoothfem
