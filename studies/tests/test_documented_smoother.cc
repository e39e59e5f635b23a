// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "smoothing/loop/smooth.h"
#include "smoothing/tests/volume_meshes.h"
#include "studies/tests/study_tests.h"

// This executable contains the smoother of docs/how-to/smoother-in-cpp.md and a second one.

namespace smoothfem {
namespace {

TEST(DocumentedSmoother, IsAMethodThatRaisesTheQuality) {
  Method<2> method = make_method<2>("half-laplace");
  PlanarMesh mesh = shaken_grid(8, 0.2);
  const double before = mesh_quality(mesh).q_mean;
  const SmoothingResult result = smooth(mesh, method);
  EXPECT_GT(result.quality.q_mean, before);
  EXPECT_EQ(result.quality.n_invalid, 0u);
}

TEST(DocumentedSmoother, ASecondOneHasItsOwnParameters) {
  Method<3> method = make_method<3>("short-edge-laplace");
  method.set("exponent", "1.5");
  EXPECT_NE(input_error_of([&] { method.set("exponent", "-1"); }), "");
  VolumeMesh mesh = test::box_mesh(5, 5, 5, test::BoxCells::tetrahedra);
  test::distort(mesh, 0.3, 1);
  const double before = mesh_quality(mesh).q_mean;
  EXPECT_GT(smooth(mesh, method).quality.q_mean, before);
}

}  // namespace
}  // namespace smoothfem
