// SPDX-License-Identifier: GPL-3.0-or-later
// Finite element numbers of the hexahedral flange of the study `volume`, from badly distorted to
// smoothed. Gauss points chosen for each cell are compared with twenty per direction.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/poisson_solver.h"
#include "meshes/distortion/distort.h"
#include "meshes/domains/catalogue.h"
#include "smoothing/loop/smooth.h"

namespace smoothfem {
namespace {

VolumeMesh distorted_flange() {
  const AnyMesh made = find_domain("flange").generate({.elements = "hexahedra", .edge_scale = 2.8});
  VolumeMesh mesh = std::get<VolumeMesh>(made);
  distort(mesh, DistortionParameters{.target_q_mean = 0.4631});
  return mesh;
}

/// Returns the initial mesh, and the meshes of GETMe whose numbers depend most on the rule: after
/// ten iterations and at the end.
std::vector<std::vector<Point<3>>> meshes_of_getme(VolumeMesh mesh) {
  std::vector<std::vector<Point<3>>> meshes;
  auto method = make_method<3>("getme");
  smooth(mesh, method, [&](const IterationRecord& record, const VolumeMesh& now) {
    if (record.record == 0 || record.record == 10) meshes.push_back(now.copied_coordinates());
  });
  meshes.push_back(mesh.copied_coordinates());
  return meshes;
}

class HexahedronPoints : public testing::TestWithParam<int> {};

TEST_P(HexahedronPoints, ChosenOnesAgreeWithTwentyADirection) {
  const VolumeMesh mesh = distorted_flange();
  const auto meshes = meshes_of_getme(mesh);
  ASSERT_EQ(meshes.size(), 3u);
  const auto solver_with = [&](int n_points) {
    PoissonOptions options{.degree = GetParam(), .boundary_in_norm = true};
    options.tensor_points.hexahedron = n_points;
    options.jacobi_cg = Recorded::never;
    return PoissonSolver<3>(&mesh, options);
  };
  auto chosen = solver_with(0), twenty = solver_with(20);
  const auto& solution = manufactured_solution<3>("volume");
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const auto solved = chosen.solve(meshes[m], solution);
    const auto exact = twenty.solve(meshes[m], solution);
    EXPECT_EQ(solved.status, "ok");
    EXPECT_GT(solved.most_points, 6);
    for (const auto number : {&SolutionRecord::condition_number, &SolutionRecord::e_max,
                              &SolutionRecord::e_mean, &SolutionRecord::e_l2, &SolutionRecord::e_h1,
                              &SolutionRecord::l2_error, &SolutionRecord::h1_error})
      EXPECT_NEAR(solved.*number / (exact.*number), 1.0, 1e-4) << "mesh " << m;
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, HexahedronPoints, testing::Values(1, 2));

}  // namespace
}  // namespace smoothfem
