// SPDX-License-Identifier: GPL-3.0-or-later
/// One cycle of GETMe sequential, against the rules of Section 4.3 written as plain loops.
#include <gtest/gtest.h>

#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/tests/element_step.h"
#include "smoothing/tests/planar_meshes.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

/// Penalties so large that they decide which element is next.
constexpr double penalty_invalid = 0.05, penalty_repeated = 0.02, penalty_success = -0.01;
constexpr int n_transformations = 60;

struct Outcome {
  int n_undone = 0, n_repeated = 0;
};

/// Transforms the element with the smallest sum of quality and penalty, again and again.
Outcome transform_worst_elements(PlanarMesh& mesh, const ElementParameters<2>& parameters) {
  const ElementRegularization<2> element(parameters);
  const Topology& topology = mesh.topology();
  std::vector<double> penalties(topology.n_cells());
  CellIndex last = topology.n_cells();
  Outcome outcome;
  for (int i = 0; i < n_transformations; ++i) {
    const auto corrected = [&](CellIndex c) { return cell_mean_ratio(mesh, c) + penalties[c]; };
    CellIndex worst = topology.n_cells();
    for (CellIndex c = 0; c < topology.n_cells(); ++c)
      if (topology.has_free_node(c) &&
          (worst == topology.n_cells() || corrected(c) < corrected(worst)))
        worst = c;
    const auto nodes = topology.cell_nodes(worst);
    const auto result = test::transformed(element, mesh, worst);
    const auto old = mesh.copied_coordinates();
    for (std::size_t k = 0; k < nodes.size(); ++k)
      if (!topology.is_fixed(nodes[k])) mesh.coordinates()[nodes[k]] = result[k];
    const bool kept = mesh_quality(mesh).n_invalid == 0;
    if (!kept)
      for (const NodeIndex node : nodes) mesh.coordinates()[node] = old[node];
    penalties[worst] += kept ? penalty_success : penalty_invalid;
    if (worst == last) penalties[worst] += penalty_repeated;
    penalties[worst] = std::max(penalties[worst], 0.0);
    outcome.n_undone += kept ? 0 : 1;
    outcome.n_repeated += worst == last ? 1 : 0;
    last = worst;
  }
  return outcome;
}

/// Small steps pick an element repeatedly; large steps are undone.
TEST(GetmeSequential, ACycleFollowsTheRulesOfTheThesis) {
  Outcome outcome;
  for (const double rho : {0.02, 1.0})
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
      PlanarMesh expected = test::grid_mesh(5, test::GridCells::mixed);
      test::distort(expected, 0.9, seed);
      PlanarMesh mesh = expected;
      ElementParameters<2> parameters{.lambda = 0.5, .theta_degrees = 45.0, .rho = rho};
      auto method = make_method<2>("getme-sequential");
      const auto set = [&](const std::string& name, double value) {
        method.set(name, std::to_string(value));
      };
      set("lambda", parameters.lambda);
      set("theta", parameters.theta_degrees);
      set("rho", parameters.rho);
      set("penalty_invalid", penalty_invalid);
      set("penalty_repeated", penalty_repeated);
      set("penalty_success", penalty_success);
      method.set("cycle", std::to_string(n_transformations));
      method.set("max_cycles", "1");
      const SmoothingResult result = smooth(mesh, method);
      const auto [n_undone, n_repeated] = transform_worst_elements(expected, parameters);
      ASSERT_GT(result.result_record, 0u) << "the initial mesh is the best";
      outcome.n_undone += n_undone;
      outcome.n_repeated += n_repeated;
      for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
        EXPECT_LT((mesh.coordinates()[i] - expected.coordinates()[i]).norm(), 1e-12)
            << rho << ' ' << seed << ' ' << i;
    }
  EXPECT_GT(outcome.n_undone, 10) << "otherwise a penalty is not tested";
  EXPECT_GT(outcome.n_repeated, 10) << "otherwise a penalty is not tested";
}

TEST(GetmeSequential, EndsWhenTheMeshIsPerfect) {
  VolumeMesh mesh = test::box_mesh(4, 4, 4, test::BoxCells::hexahedra);
  test::distort(mesh, 0.2, 3);
  auto method = make_method<3>("getme");
  const auto result = smooth(mesh, method);
  EXPECT_EQ(result.stages[1].why_stopped, "it converged");
  EXPECT_LT(result.stages[1].iterations, 5000u);
  EXPECT_GT(result.quality.q_min, 1.0 - 1e-4);
  mesh = test::box_mesh(4, 4, 4, test::BoxCells::hexahedra);
  auto sequential = make_method<3>("getme-sequential");
  EXPECT_EQ(smooth(mesh, sequential).stages[0].iterations, 0u);
}

}  // namespace
}  // namespace smoothfem
