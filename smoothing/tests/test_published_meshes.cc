// SPDX-License-Identifier: GPL-3.0-or-later
/// Tests global optimization on the published gear meshes (Table 6.1:
/// studies/tests/test_printed_tables.cc).
#include <gtest/gtest.h>

#include "meshes/io/mesh_file.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/optimization/shape_objective.h"
#include "smoothing/tests/shared_mesh.h"

namespace smoothfem {
namespace {

/// Expects the minima of an independent optimizer.
TEST(GlobalOptimization, ReachesTheKnownMinimaAtEveryScale) {
  for (const auto& [name, minimum] :
       {std::pair{"gear_tri_initial.mesh", 18706.636}, {"gear_quad_initial.mesh", 6659.553}}) {
    const auto path = test::shared_mesh(name);
    if (path.empty()) GTEST_SKIP() << test::how_to_get(name);
    const PlanarMesh initial = planar_mesh(read_mesh(path), path);
    const ShapeObjective<2> objective(initial.shared_topology());
    std::string iterations;
    for (const double scale : {1.0, 1e-6, 1e6}) {
      PlanarMesh mesh = initial;
      for (auto& p : mesh.coordinates()) p *= scale;
      Method<2> method = make_method<2>("global-optimization");
      const auto result = smooth(mesh, method);
      EXPECT_NEAR(objective.value(mesh.copied_coordinates()), minimum, 5e-4)
          << name << ' ' << scale;
      if (iterations.empty()) iterations = result.iterations_text();
      EXPECT_EQ(result.iterations_text(), iterations) << name << ' ' << scale;
    }
  }
}

}  // namespace
}  // namespace smoothfem
