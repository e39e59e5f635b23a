// SPDX-License-Identifier: GPL-3.0-or-later
/// Requirements for every method. A new method is tested as soon as it is registered.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "smoothing/base/parallel.h"
#include "smoothing/geometry/cell_size.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/quality/cell_targets.h"
#include "smoothing/surface/sliding_boundary.h"
#include "smoothing/tests/methods.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using test::box_mesh;
using test::BoxCells;
using test::distorted_meshes;
using test::grid_mesh;
using test::GridCells;
using test::regular_topologies;

/// Meshes on which no method moves a node.
template <int dim>
std::vector<Mesh<dim>> regular_patches() {
  if constexpr (dim == 2)
    return {grid_mesh(6, GridCells::quadrilaterals), grid_mesh(6, GridCells::triangles, true),
            test::honeycomb_mesh()};
  else
    return {box_mesh(4, 4, 4, BoxCells::hexahedra), test::equilateral_prisms(5, 3)};
}

/// A mesh with one node beyond its neighbours.
template <int dim>
Mesh<dim> tangled_mesh() {
  auto mesh = [] {
    if constexpr (dim == 2)
      return grid_mesh(4, GridCells::triangles);
    else
      return box_mesh(4, 4, 4, BoxCells::hexahedra);
  }();
  const NodeIndex moved = mesh.topology().free_nodes()[0];
  mesh.coordinates()[moved] += Point<dim>::Constant(2.2);
  return mesh;
}

template <int dim>
double farthest(const Mesh<dim>& a, const Mesh<dim>& b) {
  double longest = 0.0;
  for (std::size_t i = 0; i < a.n_nodes(); ++i)
    longest = std::max(longest, (a.coordinates()[i] - b.coordinates()[i]).norm());
  return longest;
}

template <int dim>
Eigen::Matrix<double, dim, dim> rotation() {
  if constexpr (dim == 2)
    return Eigen::Rotation2Dd(0.9).toRotationMatrix();
  else
    return Eigen::AngleAxisd(0.9, Point<3>(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
}

class EveryMethod : public testing::TestWithParam<std::string> {
 protected:
  /// Calls check<dim>() for the dimensions that the method supports.
  template <class Check>
  static void in_every_dimension(const Check& check) {
    const std::string name = GetParam().substr(0, GetParam().find(' '));
    if (supports_mesh_kind<2>(name)) check.template operator()<2>();
    if (supports_mesh_kind<3>(name)) check.template operator()<3>();
  }
  template <int dim>
  static Method<dim> method() {
    return test::make_variant<dim>(GetParam());
  }
  /// Makes the method with so few iterations that differences in rounding cannot grow.
  template <int dim>
  static Method<dim> short_method(const std::string& n_iterations = "5") {
    return test::short_method<dim>(GetParam(), n_iterations);
  }
  template <int dim>
  static bool claims_validity() {
    return test::claims_validity(method<dim>());
  }
};

TEST_P(EveryMethod, ImprovesDistortedMeshesOfEveryTypeAndMovesOnlyFreeNodes) {
  in_every_dimension([]<int dim>() {
    for (const auto& [name, mesh] : distorted_meshes<dim>()) {
      Mesh<dim> result = mesh;
      auto made = method<dim>();
      smooth(result, made);
      for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
        if (mesh.topology().is_fixed(i)) {
          EXPECT_EQ(result.copied_coordinates()[i], mesh.copied_coordinates()[i])
              << name << " node " << i;
        }
      EXPECT_EQ(&result.topology(), &mesh.topology()) << name;
      EXPECT_GT(mesh_quality(result).q_star_min, mesh_quality(mesh).q_star_min) << name;
      EXPECT_GT(mesh_quality(result).q_mean, mesh_quality(mesh).q_mean) << name;
    }
  });
}

TEST_P(EveryMethod, KeepsRegularPatches) {
  in_every_dimension([]<int dim>() {
    for (const auto& mesh : regular_patches<dim>()) {
      Mesh<dim> result = mesh;
      auto made = short_method<dim>();
      smooth(result, made);
      EXPECT_LT(farthest(result, mesh), 1e-11);
    }
  });
}

TEST_P(EveryMethod, CommutesWithSimilarities) {
  in_every_dimension([]<int dim>() {
    const Eigen::Matrix<double, dim, dim> turned = rotation<dim>();
    const Point<dim> shift = Point<dim>::LinSpaced(30.0, -70.0);
    for (const double scale : {1e-100, 1e-9, 1e-3, 25.0, 1e9, 1e100})
      for (const auto& [name, mesh] : distorted_meshes<dim>()) {
        const auto similar = [&](Mesh<dim> m) {
          for (auto& p : m.coordinates()) p = scale * (turned * p + shift);
          return m;
        };
        Mesh<dim> here = mesh, there = similar(mesh);
        auto first = short_method<dim>(), second = short_method<dim>();
        const auto a = smooth(here, first), b = smooth(there, second);
        EXPECT_EQ(a.iterations_text(), b.iterations_text()) << name << ' ' << scale;
        EXPECT_LT(farthest(similar(here), there), 1e-8 * scale) << name << ' ' << scale;
      }
  });
}

/// Cells have size 1; their coordinates keep nine digits.
TEST_P(EveryMethod, GivesTheSameMeshFarFromTheOrigin) {
  in_every_dimension([]<int dim>() {
    const Point<dim> far = Point<dim>::LinSpaced(1e7, -2e7);
    for (const auto& [name, mesh] : distorted_meshes<dim>()) {
      const auto moved = [&](Mesh<dim> m) {
        for (auto& p : m.coordinates()) p += far;
        return m;
      };
      Mesh<dim> here = mesh, there = moved(mesh);
      auto first = short_method<dim>(), second = short_method<dim>();
      const auto a = smooth(here, first), b = smooth(there, second);
      EXPECT_EQ(a.iterations_text(), b.iterations_text()) << name;
      EXPECT_LT(farthest(moved(here), there), 1e-6) << name;
    }
  });
}

TEST_P(EveryMethod, IsBitwiseReproducible) {
  in_every_dimension([]<int dim>() {
    auto reused = method<dim>();  // for meshes that become larger and smaller
    for (const auto& [name, mesh] : distorted_meshes<dim>()) {
      Mesh<dim> first = mesh;
      auto made = method<dim>();
      smooth(first, made);
      for (auto* before : {&made, &reused}) {
        Mesh<dim> again = mesh;
        smooth(again, *before);
        EXPECT_EQ(first.copied_coordinates(), again.copied_coordinates())
            << name << ": the method keeps a state";
      }
    }
  });
}

// Captures are named because clang 14 does not support capturing structured bindings by [&].

TEST_P(EveryMethod, ReportsEveryIterationToTheObserverAndGivesTheSameMeshWithoutIt) {
  in_every_dimension([]<int dim>() {
    for (const auto& [name, mesh] : distorted_meshes<dim>()) {
      Mesh<dim> result = mesh;
      auto made = method<dim>();
      std::vector<IterationRecord> records;
      const auto summary = smooth(
          result, made, [&, &name = name, &mesh = mesh](const auto& record, const auto& seen) {
            const MeshQuality quality = mesh_quality(seen);
            EXPECT_EQ(record.quality.q_min, quality.q_min) << name;
            EXPECT_EQ(record.quality.q_mean, quality.q_mean) << name;
            EXPECT_EQ(record.quality.q_star_min, quality.q_star_min) << name;
            if (record.record == 0) {
              EXPECT_EQ(seen.copied_coordinates(), mesh.copied_coordinates()) << name;
            }
            records.push_back(record);
          });
      ASSERT_GT(records.size(), made.stages.size()) << name;
      EXPECT_EQ(records[0].stage, "initial");
      for (std::size_t i = 1; i < records.size(); ++i) {
        EXPECT_EQ(records[i].record, i);
        EXPECT_GE(records[i].smoothing_seconds, records[i - 1].smoothing_seconds);
        if (records[i].stage == records[i - 1].stage) {
          EXPECT_GT(records[i].iteration, records[i - 1].iteration);
        }
      }
      EXPECT_EQ(records.back().iteration, summary.stages.back().iterations);
      EXPECT_EQ(summary.quality.q_mean, mesh_quality(result).q_mean) << name;
      Mesh<dim> unseen = mesh;
      auto other = method<dim>();
      const auto summary_of_unseen = smooth(unseen, other);
      EXPECT_EQ(result.copied_coordinates(), unseen.copied_coordinates()) << name;
      EXPECT_EQ(summary.quality.q_mean, summary_of_unseen.quality.q_mean) << name;
      EXPECT_EQ(summary.iterations_text(), summary_of_unseen.iterations_text()) << name;
    }
  });
}

TEST_P(EveryMethod, KeepsTheMeshValidIfItPromisesTo) {
  in_every_dimension([]<int dim>() {
    if (!claims_validity<dim>()) GTEST_SKIP() << "the method does not promise valid meshes";
    for (auto& [name, mesh] : distorted_meshes<dim>()) {
      test::distort(mesh, 0.9, 11);
      auto made = method<dim>();
      smooth(mesh, made, [&, &name = name](const IterationRecord& record, const auto& seen) {
        EXPECT_EQ(mesh_quality(seen).n_invalid, 0u) << name << ' ' << record.record;
      });
    }
  });
}

TEST_P(EveryMethod, LeavesNoCellWorseThanTheWorstOneIfAsked) {
  in_every_dimension([]<int dim>() {
    for (auto& [name, mesh] : distorted_meshes<dim>()) {
      test::distort(mesh, 0.4, 5);
      const double floor = mesh_quality(mesh).q_min;
      auto made = short_method<dim>();
      made.set("floor", "initial");
      const auto outcome = smooth(mesh, made);
      EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u) << name;
      EXPECT_GE(mesh_quality(mesh).q_min, floor) << name;
      EXPECT_EQ(outcome.quality.q_min, mesh_quality(mesh).q_min) << name;
    }
  });
}

/// The mesh with two materials left and right of x. The nodes between them stay.
template <int dim>
Mesh<dim> with_interface(const Mesh<dim>& mesh, double x) {
  MeshLabels labels;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    Point<dim> sum = Point<dim>::Zero();
    for (const NodeIndex i : mesh.topology().cell_nodes(c)) sum += mesh.coordinates()[i];
    labels.cell_tags.push_back(
        sum.x() < x * static_cast<double>(mesh.topology().cell_nodes(c).size()) ? 1 : 2);
  }
  const Topology topology(dim, mesh.n_nodes(), mesh.topology().cells(), std::nullopt, labels);
  auto reasons = topology.fixed_reasons();
  add_implied_reasons(topology, reasons);
  return {std::make_shared<const Topology>(dim, mesh.n_nodes(), mesh.topology().cells(),
                                           std::move(reasons), labels),
          mesh.copied_coordinates()};
}

TEST_P(EveryMethod, KeepsInterfacesBitwise) {
  in_every_dimension([]<int dim>() {
    for (const auto& [name, shaken] : distorted_meshes<dim>()) {
      double middle = 0.0;
      for (const auto& point : shaken.coordinates())
        middle += point.x() / static_cast<double>(shaken.n_nodes());
      const Mesh<dim> mesh = with_interface(shaken, middle);
      std::size_t n_inner = 0;
      Mesh<dim> result = mesh;
      auto made = short_method<dim>();
      smooth(result, made);
      for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
        if (!has(mesh.topology().fixed_reasons(i), FixedReason::interface)) continue;
        n_inner += !mesh.topology().on_boundary()[i];
        EXPECT_EQ(result.copied_coordinates()[i], mesh.copied_coordinates()[i]) << name << ' ' << i;
      }
      EXPECT_GT(n_inner, 0u) << name;
    }
  });
}

/// Checks that nodes slide on the interface x = 2 of boxes or squares and do not leave it.
template <int dim>
void slide_on_plane_interface(const std::vector<Mesh<dim>>& meshes, const auto& make_method) {
  for (const Mesh<dim>& box : meshes) {
    Mesh<dim> mesh = with_interface(box, 2.0);
    std::vector<NodeIndex> on_interface;
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      if (mesh.coordinates()[i].x() == 2.0 && !mesh.topology().on_boundary()[i])
        on_interface.push_back(i);
    mesh = with_sliding_boundary(mesh, {}, default_slide_distance,
                                 {.boundary = false, .interfaces = true});
    for (std::size_t k = 0; k < on_interface.size(); ++k)
      mesh.coordinates()[on_interface[k]][1] += k % 2 == 0 ? 0.2 : -0.2;
    const Mesh<dim> before = mesh;
    auto made = make_method.template operator()<dim>();
    smooth(mesh, made);
    bool any_moved = false;
    for (const NodeIndex i : on_interface) {
      EXPECT_NEAR(mesh.coordinates()[i].x(), 2.0, 1e-12);
      any_moved = any_moved || mesh.coordinates()[i] != before.coordinates()[i];
    }
    EXPECT_TRUE(any_moved);
    for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
      if (mesh.topology().on_boundary()[i]) {
        EXPECT_EQ(mesh.coordinates()[i], before.coordinates()[i]);
      }
  }
}

TEST_P(EveryMethod, SlidesOnAPlaneInterfaceWithoutLeavingIt) {
  const std::string name = GetParam().substr(0, GetParam().find(' '));
  const auto make = []<int dim>() { return short_method<dim>(); };
  if (supports_mesh_kind<2>(name, true))
    slide_on_plane_interface<2>(
        {grid_mesh(4, GridCells::quadrilaterals), grid_mesh(4, GridCells::triangles)}, make);
  if (!supports_mesh_kind<3>(name, true)) GTEST_SKIP() << "the method keeps no constraints";
  slide_on_plane_interface<3>(
      {box_mesh(4, 4, 4, BoxCells::hexahedra), box_mesh(4, 4, 4, BoxCells::tetrahedra),
       box_mesh(4, 4, 4, BoxCells::prisms)},
      make);
}

/// A mesh whose cells are stretched and sheared by a map, and the same with its inner nodes moved.
template <int dim>
std::pair<Mesh<dim>, Mesh<dim>> stretched_and_shaken(Mesh<dim> mesh) {
  Eigen::Matrix<double, dim, dim> map = 0.3 * Eigen::Matrix<double, dim, dim>::Identity();
  map(0, 0) = 2.0;
  map(0, 1) = 0.2;
  for (auto& x : mesh.coordinates()) x = map * x;
  Mesh<dim> shaken = mesh;
  const auto& free_nodes = mesh.topology().free_nodes();
  for (std::size_t k = 0; k < free_nodes.size(); ++k)
    shaken.coordinates()[free_nodes[k]] += map * Point<dim>::Constant(k % 2 == 0 ? 0.15 : -0.1);
  return {mesh, shaken};
}

TEST_P(EveryMethod, ReachesItsTargetsOrRefusesThem) {
  in_every_dimension([]<int dim>() {
    std::vector<Mesh<dim>> meshes;
    if constexpr (dim == 2)
      meshes = {grid_mesh(4, GridCells::quadrilaterals), grid_mesh(4, GridCells::triangles)};
    else
      meshes = {box_mesh(3, 3, 3, BoxCells::hexahedra), box_mesh(3, 3, 3, BoxCells::tetrahedra)};
    for (const auto& mesh : meshes) {
      const auto [reference, shaken] = stretched_and_shaken<dim>(mesh);
      Mesh<dim> result = with_targets(shaken, targets_of(reference, TargetKind::shape_and_size));
      auto made = method<dim>();
      if (!takes_targets(made)) {
        EXPECT_THROW(smooth(result, made), InputError);
        continue;
      }
      EXPECT_LT(mesh_quality(result).q_mean, 0.99);
      smooth(result, made);
      EXPECT_GT(mesh_quality(result).q_min, 0.999);
      EXPECT_LT(farthest(reference, result), 0.15 * farthest(reference, shaken));
    }
  });
}

TEST_P(EveryMethod, KeepsSizesThatAreItsTargets) {
  const std::string name = GetParam().substr(0, GetParam().find(' '));
  if (!supports_mesh_kind<2>(name) || !takes_targets(method<2>()))
    GTEST_SKIP() << "the method takes no targets";
  PlanarMesh graded = grid_mesh(8, GridCells::triangles);
  test::distort(graded, 0.2, 3);
  for (auto& x : graded.coordinates()) x = x.cwiseProduct(x / 8.0 + Point<2>::Constant(0.05));
  ASSERT_EQ(mesh_quality(graded).n_invalid, 0u);
  const auto smoothed = [&](PlanarMesh mesh) {
    auto made = method<2>();
    smooth(mesh, made);
    return mesh;
  };
  const auto mean_change = [&](const PlanarMesh& mesh) {
    double sum = 0.0;
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      sum += std::abs(std::log(signed_cell_size(mesh, c) / signed_cell_size(graded, c)));
    return sum / static_cast<double>(mesh.n_cells());
  };
  const PlanarMesh result =
      smoothed(with_targets(graded, targets_of(graded, TargetKind::size, initial_size_bound)));
  EXPECT_LT(mean_change(result), mean_change(smoothed(graded)));
  EXPECT_TRUE(mesh_quality(result).q_mean > mesh_quality(graded).q_mean ||
              mesh_quality(result).q_min > mesh_quality(graded).q_min);
  for (CellIndex c = 0; c < graded.n_cells(); ++c) {
    const double factor = signed_cell_size(result, c) / signed_cell_size(graded, c);
    EXPECT_LT(factor, initial_size_bound) << c;
    EXPECT_GT(factor, 1.0 / initial_size_bound) << c;
  }
}

TEST(GlobalOptimization, EndsOnPerfectLayeredAndGradedMeshes) {
  const auto steps = [](PlanarMesh mesh, const std::string& stall = "1e-4") {
    auto made = make_method<2>("global-optimization");
    made.set("stall", stall);
    return smooth(mesh, made).stages.at(0).iterations;
  };
  const PlanarMesh perfect = grid_mesh(16, GridCells::quadrilaterals);
  EXPECT_LE(steps(perfect), 2u);
  PlanarMesh layered = perfect, graded = grid_mesh(16, GridCells::triangles);
  for (auto& x : layered.coordinates()) x.y() *= 0.01;
  test::distort(graded, 0.2, 3);
  for (auto& x : graded.coordinates()) x = x.cwiseProduct(x);
  EXPECT_LT(steps(layered), 60u);
  EXPECT_LT(steps(graded), 60u);
  EXPECT_GT(steps(graded), 10u);
  EXPECT_EQ(steps(graded, "1"), 10u) << "no step lowers the objective by more than itself";
}

TEST_P(EveryMethod, RefusesTangledMeshesIfItNeedsValidMeshes) {
  in_every_dimension([]<int dim>() {
    auto mesh = tangled_mesh<dim>();
    const auto tangled = mesh.copied_coordinates();
    auto made = method<dim>();
    if (claims_validity<dim>()) {
      EXPECT_THROW(smooth(mesh, made), InputError);
      EXPECT_EQ(mesh.copied_coordinates(), tangled);
    } else {
      EXPECT_NO_THROW(smooth(mesh, made));
      EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u) << "these grids untangle";
    }
  });
}

TEST_P(EveryMethod, AcceptsUnusedNodes) {
  in_every_dimension([]<int dim>() {
    auto without = regular_topologies<dim>()[1].second;
    auto coordinates = without.copied_coordinates();
    coordinates.push_back(Point<dim>::Constant(2.2));
    Mesh<dim> with_unused(
        std::make_shared<const Topology>(dim, coordinates.size(), without.topology().cells()),
        coordinates);
    test::distort(with_unused, 0.3, 2);
    test::distort(without, 0.3, 2);
    auto made = method<dim>(), other = method<dim>();
    smooth(with_unused, made);
    smooth(without, other);
    EXPECT_EQ(with_unused.copied_coordinates().back(), Point<dim>::Constant(2.2));
    for (std::size_t i = 0; i < without.n_nodes(); ++i)
      EXPECT_EQ(with_unused.copied_coordinates()[i], without.copied_coordinates()[i]) << i;
  });
}

TEST_P(EveryMethod, AcceptsMeshesWithoutFreeNodes) {
  in_every_dimension([]<int dim>() {
    for (const auto& [name, free] : regular_topologies<dim>()) {
      Mesh<dim> mesh(std::make_shared<const Topology>(dim, free.n_nodes(), free.topology().cells(),
                                                      std::vector<bool>(free.n_nodes(), true)),
                     free.copied_coordinates());
      auto made = method<dim>();
      smooth(mesh, made);
      EXPECT_EQ(mesh.copied_coordinates(), free.copied_coordinates()) << name;
    }
  });
}

/// Large enough for several blocks of cells and for internal reordering.
TEST_P(EveryMethod, IsBitwiseIdenticalForEveryNumberOfThreads) {
  const int default_threads = n_threads();
  in_every_dimension([]<int dim>() {
    auto mesh = [] {
      if constexpr (dim == 2)
        return grid_mesh(140, GridCells::mixed);
      else
        return box_mesh(22, 22, 34, BoxCells::mixed);
    }();
    test::distort(mesh, 0.6, 3);
    ASSERT_GT(mesh.topology().blocks().size(), 1u);
    std::vector<Mesh<dim>> results;
    for (const int threads : {1, 2, 3, 8}) {
      set_n_threads(threads);
      results.push_back(mesh);
      auto made = short_method<dim>("3");
      smooth(results.back(), made);
      EXPECT_EQ(results.back().copied_coordinates(), results.front().copied_coordinates())
          << threads;
    }
    EXPECT_NE(results.front().copied_coordinates(), mesh.copied_coordinates());
  });
  set_n_threads(default_threads);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryMethod, testing::ValuesIn(test::variant_names()),
                         test::test_name);

}  // namespace
}  // namespace smoothfem
