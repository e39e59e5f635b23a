// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tests/flange_tests.h"

namespace smoothfem {
namespace {

TEST(Flange, TetrahedraHaveTheCountsOfTheThesis) {
  const VolumeMesh mesh = generate_flange({ElementType::tetrahedron, 1.0});
  expect_flange(mesh, ElementType::tetrahedron, 566004, 0.02, 0.002);
  EXPECT_NEAR(static_cast<double>(mesh.n_nodes()), 103230, 0.02 * 103230);
}

}  // namespace
}  // namespace smoothfem
