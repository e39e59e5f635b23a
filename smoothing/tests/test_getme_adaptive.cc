// SPDX-License-Identifier: GPL-3.0-or-later
/// One iteration of GETMe adaptive, against Eq. 4.3 and Fig. 4.4 written as plain loops.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/smooth.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/tests/element_step.h"
#include "smoothing/tests/planar_meshes.h"

namespace smoothfem {
namespace {

const std::vector<double> relaxation = {0.9, 0.3, 0.1, 0.0};

/// Returns the elements that share a node with an element, without itself.
std::set<CellIndex> neighbours(const Topology& topology, CellIndex cell) {
  std::set<CellIndex> found;
  for (const NodeIndex i : topology.cell_nodes(cell))
    for (const CellIndex c : topology.node_cells(i)) found.insert(c);
  found.erase(cell);
  return found;
}

/// Returns the weight of an element (Eq. 4.3).
double weight(const PlanarMesh& mesh, CellIndex cell) {
  const auto others = neighbours(mesh.topology(), cell);
  double sum = 0.0;
  for (const CellIndex c : others) sum += cell_mean_ratio(mesh, c);
  return std::sqrt(sum / (static_cast<double>(others.size()) * cell_mean_ratio(mesh, cell)));
}

/// Returns the weighted means of the transformed positions of all nodes.
std::vector<Point<2>> means(const PlanarMesh& mesh, const ElementParameters<2>& parameters) {
  const ElementRegularization<2> element(parameters);
  std::vector<Point<2>> sums(mesh.n_nodes(), Point<2>::Zero());
  std::vector<double> weights(mesh.n_nodes());
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto nodes = mesh.topology().cell_nodes(c);
    const auto result = test::transformed(element, mesh, c);
    const double w = weight(mesh, c);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      sums[nodes[k]] += w * result[k];
      weights[nodes[k]] += w;
    }
  }
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) sums[i] /= weights[i];
  return sums;
}

/// Does one iteration. Returns the number of shortened movements.
int iterate(PlanarMesh& mesh, const ElementParameters<2>& parameters) {
  const auto& free_nodes = mesh.topology().free_nodes();
  const auto old = mesh.copied_coordinates();
  const auto goals = means(mesh, parameters);
  std::map<NodeIndex, std::size_t> level;
  for (const NodeIndex i : free_nodes) level[i] = 0;
  int n_shortened = 0;
  while (true) {
    for (const auto& [i, l] : level)
      mesh.coordinates()[i] = (1.0 - relaxation[l]) * old[i] + relaxation[l] * goals[i];
    std::set<NodeIndex> of_invalid;
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      if (!(cell_mean_ratio(mesh, c) > 0.0))
        for (const NodeIndex i : mesh.topology().cell_nodes(c))
          if (level.contains(i) && level[i] + 1 < relaxation.size()) of_invalid.insert(i);
    if (of_invalid.empty()) return n_shortened;
    for (const NodeIndex i : of_invalid) ++level[i];
    n_shortened += static_cast<int>(of_invalid.size());
  }
}

TEST(GetmeAdaptive, AnIterationFollowsTheRulesOfTheThesis) {
  const ElementParameters<2> parameters{.lambda = 0.5, .theta_degrees = 45.0, .rho = 1.0};
  int n_shortened = 0, n_seen = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    PlanarMesh expected = test::grid_mesh(6, test::GridCells::mixed);
    test::distort(expected, 0.9, seed);
    for (auto& point : expected.coordinates()) point.y() *= 0.1;  // flat cells: steps go too far
    PlanarMesh mesh = expected;
    auto method = make_method<2>("getme-adaptive");
    method.set("mean.lambda", "0.5");
    method.set("mean.theta", "45");
    method.set("mean.relaxation", "0.9, 0.3, 0.1, 0");
    n_shortened += iterate(expected, parameters);
    smooth(mesh, method, [&](const IterationRecord& record, const PlanarMesh& seen) {
      if (record.stage != "mean" || record.iteration != 1) return;
      ++n_seen;
      for (NodeIndex i = 0; i < seen.n_nodes(); ++i)
        EXPECT_LT((seen.coordinates()[i] - expected.coordinates()[i]).norm(), 1e-12) << i;
    });
  }
  EXPECT_EQ(n_seen, 4) << "iterations that were compared";
  EXPECT_GT(n_shortened, 10) << "otherwise relaxation is not tested";
}

}  // namespace
}  // namespace smoothfem
