// SPDX-License-Identifier: GPL-3.0-or-later
/// Periodic maps, copies of cells beyond periodic sides, and smoothing on the torus.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "smoothing/geometry/cell_size.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/periodic/halo.h"
#include "smoothing/periodic/smooth_periodic.h"
#include "smoothing/surface/sliding_boundary.h"
#include "smoothing/tests/periodic_meshes.h"

namespace smoothfem {
namespace {

using test::with_periodic_sides;

constexpr int n = 4;

PlanarMesh planar_torus(const std::vector<int>& directions, test::GridCells cells) {
  return with_periodic_sides(test::grid_mesh(n, cells), n, directions);
}

/// Moves every node by a periodic field, so that partners stay partners.
template <int dim>
void shake(Mesh<dim>& mesh, bool moves_sides) {
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    if (!moves_sides && mesh.topology().on_boundary()[i]) continue;
    const Point<dim> x = mesh.coordinates()[i];
    for (int d = 0; d < dim; ++d)
      mesh.coordinates()[i][d] += 0.2 * std::sin(2.0 * M_PI * (x[(d + 1) % dim] + 0.7) / n) *
                                  std::cos(2.0 * M_PI * (2.0 * x[d] + 0.1 * d) / n);
  }
}

TEST(PeriodicMaps, FindShiftsAndRotations) {
  const auto maps = periodic_maps(planar_torus({0, 1}, test::GridCells::quadrilaterals));
  ASSERT_EQ(maps.size(), 2u);
  EXPECT_EQ(maps[0].motion.shift, Point<2>(n, 0));
  EXPECT_TRUE(maps[0].motion.rotation.isIdentity(0.0));
  EXPECT_EQ(maps[0].nodes.size(), 5u);

  // A sector of a quarter of a ring: the side y = 0 turns to the side x = 0.
  PlanarMesh ring = planar_torus({1}, test::GridCells::quadrilaterals);
  for (auto& x : ring.coordinates()) {
    const double angle = 0.5 * M_PI * x.y() / n, radius = 1.0 + x.x();
    x = {radius * std::cos(angle), radius * std::sin(angle)};
  }
  const auto turns = periodic_maps(ring);
  ASSERT_EQ(turns.size(), 1u);
  EXPECT_LT((turns[0].motion(Point<2>(2, 1)) - Point<2>(-1, 2)).norm(), 1e-12);

  ring.coordinates()[0].x() += 0.3;
  EXPECT_THROW(periodic_maps(ring), InputError);
}

TEST(Halo, SurroundsPeriodicNodesAlsoAtCorners) {
  for (const int n_layers : {1, 2}) {
    const PlanarMesh mesh = planar_torus({0, 1}, test::GridCells::quadrilaterals);
    const auto halo = make_halo(mesh, periodic_maps(mesh), n_layers);
    const auto width = static_cast<std::size_t>(n + 2 * n_layers);
    EXPECT_EQ(halo.cells.size(), width * width);
    const auto x = halo.coordinates(mesh.coordinates());
    const PlanarMesh all(std::make_shared<const Topology>(2, x.size(), halo.cells), x);
    double area = 0.0;
    for (CellIndex c = 0; c < all.n_cells(); ++c) {
      EXPECT_NEAR(signed_cell_size(all, c), 1.0, 1e-12);
      area += signed_cell_size(all, c);
    }
    EXPECT_NEAR(area, static_cast<double>(width * width), 1e-9);
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) EXPECT_FALSE(all.topology().on_boundary()[i]);
  }
  const VolumeMesh box =
      with_periodic_sides(test::box_mesh(2, 2, 2, test::BoxCells::hexahedra), 2, {0, 1, 2});
  const auto halo = make_halo(box, periodic_maps(box), 1);
  EXPECT_EQ(halo.cells.size(), 64u);
}

/// Returns the largest distance of a periodic node from the mean of its neighbours on both sides.
/// The side's own edges, which both sides have, count twice.
double distance_from_means(const PlanarMesh& mesh) {
  double largest = 0.0;
  for (const auto& map : periodic_maps(mesh))
    for (const auto& [node, partner] : map.nodes) {
      Point<2> sum = Point<2>::Zero();
      double count = 0.0;
      for (const NodeIndex j : mesh.topology().node_neighbours(node)) {
        sum += mesh.coordinates()[j];
        count += 1.0;
      }
      for (const NodeIndex j : mesh.topology().node_neighbours(partner)) {
        const bool on_side = std::any_of(map.nodes.begin(), map.nodes.end(),
                                         [&](const auto& pair) { return pair[1] == j; });
        if (on_side) continue;  // counted already
        sum += map.motion(mesh.coordinates()[j]);
        count += 1.0;
      }
      if (count == 4.0)  // inner nodes of the side
        largest = std::max(largest, (sum / count - mesh.coordinates()[node]).norm());
    }
  return largest;
}

TEST(SmoothPeriodic, LaplaceEndsInTheMeanOfBothSides) {
  PlanarMesh mesh = planar_torus({0}, test::GridCells::quadrilaterals);
  shake(mesh, false);
  const auto maps = periodic_maps(mesh);
  for (const auto& [node, partner] : maps.at(0).nodes)
    if (mesh.coordinates()[node].y() > 0.5 && mesh.coordinates()[node].y() < n - 0.5)
      for (const NodeIndex i : {node, partner}) mesh.coordinates()[i] += Point<2>(0.2, -0.1);
  EXPECT_GT(distance_from_means(mesh), 0.1);
  auto laplace = make_method<2>("laplace");
  laplace.set("tolerance", "1e-6");
  const auto result = smooth_periodic(mesh, laplace);
  EXPECT_LT(distance_from_means(mesh), 1e-3);
  EXPECT_GT(result.stages.at(0).iterations, 1u);
}

/// Checks that partners are the images of each other and that some have moved.
template <int dim>
void expect_moved_together(const Mesh<dim>& before, const Mesh<dim>& after) {
  bool any_moved = false;
  for (const auto& map : periodic_maps(before))
    for (const auto& [node, partner] : map.nodes) {
      EXPECT_LT((map.motion(after.coordinates()[partner]) - after.coordinates()[node]).norm(),
                1e-14)
          << node;
      any_moved = any_moved || after.coordinates()[node] != before.coordinates()[node];
    }
  EXPECT_TRUE(any_moved);
}

template <int dim>
std::vector<Mesh<dim>> shaken_tori() {
  std::vector<Mesh<dim>> meshes;
  if constexpr (dim == 2)
    for (const auto cells : {test::GridCells::quadrilaterals, test::GridCells::triangles})
      for (const auto& directions : {std::vector{0}, std::vector{0, 1}})
        meshes.push_back(planar_torus(directions, cells));
  else
    for (const auto cells : {test::BoxCells::hexahedra, test::BoxCells::tetrahedra})
      meshes.push_back(with_periodic_sides(test::box_mesh(n, n, n, cells), n, {0, 1, 2}));
  for (auto& mesh : meshes) shake(mesh, true);
  return meshes;
}

class EveryMethodOnATorus : public testing::TestWithParam<std::string> {};

TEST_P(EveryMethodOnATorus, MovesPartnersTogether) {
  const auto check = []<int dim>() {
    for (const Mesh<dim>& mesh : shaken_tori<dim>()) {
      ASSERT_EQ(mesh_quality(mesh).n_invalid, 0u);
      Mesh<dim> result = mesh;
      auto method = make_method<dim>(GetParam());
      method.floor = 1;
      smooth_periodic(result, method);
      expect_moved_together(mesh, result);
      EXPECT_GE(mesh_quality(result).q_min, mesh_quality(mesh).q_min);
    }
  };
  if (supports_mesh_kind<2>(GetParam())) check.template operator()<2>();
  if (supports_mesh_kind<3>(GetParam())) check.template operator()<3>();
}

std::vector<std::string> all_methods() {
  std::vector<std::string> names;
  for (const auto& info : method_catalogue()) names.push_back(info.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Catalogue, EveryMethodOnATorus, testing::ValuesIn(all_methods()),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(SmoothPeriodic, LaterStagesDoNotUndoEarlierOnes) {
  for (const PlanarMesh& mesh : shaken_tori<2>()) {
    const auto q_of = [&](const std::string& name) {
      PlanarMesh result = mesh;
      auto method = make_method<2>(name);
      method.floor = 1;
      const auto report = smooth_periodic(result, method);
      EXPECT_EQ(report.n_floor_reset, 0u) << name;
      EXPECT_GT(report.result_record, 0u) << name;  // 0 is the initial mesh
      return mesh_quality(result).q_star_min;
    };
    EXPECT_GE(q_of("getme"), q_of("getme-simultaneous"));
  }
}

TEST(SmoothPeriodic, SlidesPartnersInTheirSides) {
  VolumeMesh mesh = with_periodic_sides(test::box_mesh(n, n, n, test::BoxCells::hexahedra), n, {0});
  const SlidingFacets sliding = sliding_facets(mesh, {});
  PeriodicParameters<3> parameters;
  parameters.make_constraints = [&](std::span<const Point<3>> x) {
    return sliding_constraints<3>(sliding.facets, x, {}, default_slide_distance);
  };
  mesh = with_fixed_nodes(std::move(mesh), sliding.reasons);
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    const Point<3> x = mesh.coordinates()[i];
    if (x.y() == 2.0 && x.z() == 2.0) mesh.coordinates()[i] += Point<3>(0.0, 0.3, 0.2);
  }
  const VolumeMesh before = mesh;
  auto getme = make_method<3>("getme-simultaneous");
  smooth_periodic(mesh, getme, {}, parameters);
  expect_moved_together(before, mesh);
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    for (int d = 0; d < 3; ++d)
      for (const double side : {0.0, double{n}})
        if (before.coordinates()[i][d] == side) {
          EXPECT_NEAR(mesh.coordinates()[i][d], side, 1e-12);
        }
  EXPECT_GT(mesh_quality(mesh).q_min, mesh_quality(before).q_min);
}

TEST(SmoothPeriodic, KeepsMaterialsThatMeetAtTheSeam) {
  PlanarMesh mesh = planar_torus({0}, test::GridCells::quadrilaterals);
  MeshLabels labels = mesh.topology().labels();
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    labels.cell_tags.push_back(mesh.coordinates()[mesh.topology().cell_nodes(c)[0]].x() < 1.5 ? 1
                                                                                              : 2);
  shake(mesh, false);
  const Topology& old = mesh.topology();
  mesh = PlanarMesh(
      std::make_shared<const Topology>(2, old.n_nodes(), old.cells(), old.fixed_reasons(), labels),
      mesh.copied_coordinates());
  const PlanarMesh before = mesh;
  auto laplace = make_method<2>("laplace");
  smooth_periodic(mesh, laplace);
  for (const auto& map : periodic_maps(before))
    for (const auto& [node, partner] : map.nodes)
      EXPECT_EQ(mesh.coordinates()[node], before.coordinates()[node]);
}

TEST(SmoothPeriodic, RefusesMeshesWithoutPartners) {
  PlanarMesh mesh = test::grid_mesh(n, test::GridCells::quadrilaterals);
  auto laplace = make_method<2>("laplace");
  EXPECT_THROW(smooth_periodic(mesh, laplace), InputError);
}

}  // namespace
}  // namespace smoothfem
