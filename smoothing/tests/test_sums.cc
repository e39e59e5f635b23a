// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

#include "smoothing/getme/neighbour_weights.h"
#include "smoothing/getme/node_sums.h"
#include "smoothing/parts/exact_sum.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

/// Returns the numbers 0 .. n-1 in random order.
std::vector<std::uint32_t> shuffled(std::size_t n, std::uint64_t seed) {
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  test::Random random(seed);
  for (std::size_t i = n; i > 1; --i)
    std::swap(order[i - 1],
              order[std::min(i - 1, static_cast<std::size_t>((0.5 + 0.5 * random()) *
                                                             static_cast<double>(i)))]);
  return order;
}

std::shared_ptr<const Topology> shuffled(const Topology& topology) {
  return topology.reordered(shuffled(topology.n_nodes(), 1), shuffled(topology.n_cells(), 2));
}

std::vector<double> some_qualities(std::size_t n) {
  test::Random random(3);
  std::vector<double> quality(n);
  for (double& q : quality) q = 0.55 + 0.45 * random();
  return quality;
}

/// Computes Eq. 4.3 literally.
double weight_by_definition(const Topology& topology, CellIndex cell,
                            const std::vector<double>& quality) {
  std::set<CellIndex> neighbours;
  for (const NodeIndex i : topology.cell_nodes(cell))
    for (const CellIndex c : topology.node_cells(i))
      if (c != cell) neighbours.insert(c);
  double sum = 0.0;
  for (const CellIndex c : neighbours) sum += quality[c];
  return std::sqrt(sum / (static_cast<double>(neighbours.size()) * quality[cell]));
}

void expect_weights_by_definition(const std::shared_ptr<const Topology>& topology) {
  const auto quality = some_qualities(topology->n_cells());
  std::vector<CellIndex> cells(topology->n_cells());
  std::iota(cells.begin(), cells.end(), 0U);
  NeighbourWeights weights;
  weights.prepare(topology);
  weights.compute(cells, quality);
  for (const CellIndex c : cells)
    EXPECT_NEAR(weights.weights()[c], weight_by_definition(*topology, c, quality), 1e-12) << c;
}

TEST(NeighbourWeights, AreThoseOfTheDefinition) {
  for (const auto kind : {test::BoxCells::tetrahedra, test::BoxCells::hexahedra,
                          test::BoxCells::pyramids, test::BoxCells::mixed}) {
    const auto topology = test::box_mesh(4, 4, 4, kind).shared_topology();
    expect_weights_by_definition(topology);
    expect_weights_by_definition(shuffled(*topology));
  }
  expect_weights_by_definition(shuffled(test::grid_mesh(40, test::GridCells::mixed).topology()));
}

/// Neighbours are far apart in the order of cells.
TEST(NeighbourWeights, AreThoseOfTheDefinitionInAnyOrderOfManyCells) {
  expect_weights_by_definition(
      shuffled(test::grid_mesh(200, test::GridCells::quadrilaterals).topology()));
}

/// Two polygons above and below a line of ten common nodes, with many cells between them in the
/// order of cells.
void expect_common_nodes_counted_once(int n_between) {
  test::Cells cells;
  std::vector<NodeIndex> above, below;
  for (NodeIndex i = 0; i < 10; ++i) {
    above.push_back(i);
    below.insert(below.begin(), i);
  }
  above.insert(above.end(), {10, 11});
  below.insert(below.end(), {12, 13});
  cells.push_back(above);
  NodeIndex next = 14;
  for (int k = 0; k < n_between; ++k, next += 3) cells.push_back({next, next + 1, next + 2});
  cells.push_back({10, 9, 14});  // a cell that shares an edge with the first
  cells.push_back(below);
  const auto topology = std::make_shared<const Topology>(2, next, test::rows_of(cells));
  std::vector<double> quality(cells.size(), 1.0);
  quality[0] = 0.25;
  const auto last = static_cast<CellIndex>(n_between + 2);
  const std::vector<CellIndex> polygons{0, last - 1, last};
  NeighbourWeights weights;
  weights.prepare(topology);
  weights.compute(polygons, quality);
  EXPECT_NEAR(weights.weights()[0], 2.0, 1e-12);  // two neighbours of quality 1
  EXPECT_NEAR(weights.weights()[last], std::sqrt((0.25 + 1.0) / 2.0), 1e-12);
  for (const CellIndex c : polygons)
    EXPECT_NEAR(weights.weights()[c], weight_by_definition(*topology, c, quality), 1e-12) << c;
}

/// Steps between cells are stored in pieces of 16,383.
TEST(NeighbourWeights, CountPolygonsWithManyCommonNodesOnce) {
  for (const int n_between :
       {1, 5000, 8189, 8190, 8191, 8192, 16380, 16381, 16382, 16383, 16384, 40000})
    expect_common_nodes_counted_once(n_between);
}

TEST(NeighbourWeights, OfSomeCellsAreThoseOfAll) {
  const auto topology = shuffled(test::box_mesh(5, 5, 5, test::BoxCells::tetrahedra).topology());
  const auto quality = some_qualities(topology->n_cells());
  std::vector<CellIndex> all(topology->n_cells());
  std::iota(all.begin(), all.end(), 0U);
  NeighbourWeights weights;
  weights.prepare(topology);
  weights.compute(all, quality);
  const auto expected = weights.weights();
  NeighbourWeights some;
  some.prepare(topology);
  const std::vector<CellIndex> cells{3, 4, 100, 500};
  some.compute(cells, quality);
  for (const CellIndex c : cells) EXPECT_EQ(some.weights()[c], expected[c]);
}

/// Contribution of a cell to one of its nodes in these tests: numbers whose sums depend on their
/// order.
Lanes share(CellIndex cell, NodeIndex node) {
  return Lanes{1.0 / (1.0 + cell), std::sqrt(1.0 + node + cell), 1.0, 1e-3 * cell};
}

/// The nodes of a shuffled mesh are used by all of its blocks, whose sums do not fit into memory at
/// a time.
class NodeSumsOfManyBlocks : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    topology_ = shuffled(test::grid_mesh(400, test::GridCells::quadrilaterals).topology());
  }
  static void TearDownTestSuite() { topology_.reset(); }

  static NodeSums all_sums() {
    NodeSums sums;
    sums.prepare(*topology_);
    add_all(sums);
    return sums;
  }
  static void add_all(NodeSums& sums) {
    sums.compute([](std::size_t b, double* block_sums) {
      const CellBlock& block = topology_->blocks()[b];
      for (CellIndex c = block.first; c < block.last; ++c)
        for (const NodeIndex i : topology_->cell_nodes(c))
          NodeSums::add(block_sums, i, share(c, i));
    });
  }
  static std::vector<double> values(const NodeSums& sums) {
    return {sums[0], sums[0] + n_lanes * topology_->n_nodes()};
  }

  static inline std::shared_ptr<const Topology> topology_;
};

TEST_F(NodeSumsOfManyBlocks, AreTheSums) {
  ASSERT_GT(topology_->blocks().size(), 10U);
  const NodeSums sums = all_sums();
  for (NodeIndex i = 0; i < topology_->n_nodes(); ++i) {
    Lanes expected{};
    for (const CellIndex c : topology_->node_cells(i)) expected += share(c, i);
    for (std::size_t l = 0; l < n_lanes; ++l)
      ASSERT_NEAR(sums[i][l], expected[l], 1e-14 * (1.0 + std::abs(expected[l]))) << i;
  }
}

TEST_F(NodeSumsOfManyBlocks, AreTheSameForEveryNumberOfThreadsAndEveryTime) {
  const int n = n_threads();
  set_n_threads(1);
  const auto one = values(all_sums());
  set_n_threads(3);
  NodeSums sums = all_sums();
  EXPECT_EQ(values(sums), one);
  add_all(sums);
  EXPECT_EQ(values(sums), one);
  set_n_threads(n);
}

TEST_F(NodeSumsOfManyBlocks, OfSomeNodesAreSetAloneAndBitwiseIdentical) {
  NodeSums sums = all_sums();
  const auto expected = values(sums);
  std::vector<NodeIndex> nodes;
  for (NodeIndex i = 7; i < topology_->n_nodes() / 2; i += i % 3 == 0 ? 1 : 50) nodes.push_back(i);
  std::vector<bool> wanted(topology_->n_nodes(), false);
  for (const NodeIndex i : nodes) wanted[i] = true;
  const auto add_factor = [&](double factor) {
    sums.compute_some(nodes, topology_->cells_around(nodes),
                      [&](std::size_t b, std::span<const CellIndex> cells, double* block_sums) {
                        for (const CellIndex c : cells) {
                          EXPECT_GE(c, topology_->blocks()[b].first);
                          EXPECT_LT(c, topology_->blocks()[b].last);
                          for (const NodeIndex i : topology_->cell_nodes(c))
                            if (wanted[i]) NodeSums::add(block_sums, i, factor * share(c, i));
                        }
                      });
  };
  add_factor(2.0);
  for (NodeIndex i = 0; i < topology_->n_nodes(); ++i)
    for (std::size_t l = 0; l < n_lanes; ++l)
      ASSERT_EQ(sums[i][l], (wanted[i] ? 2.0 : 1.0) * expected[n_lanes * i + l]) << i;
  add_factor(1.0);
  EXPECT_EQ(values(sums), expected);
}

TEST(ExactSums, DoNotDependOnTheOrder) {
  std::vector<double> terms{1e300, -1e300, 5e-324, -3e-310, 0.0, -0.0};
  for (int k = 1; k < 2000; ++k) terms.push_back((k % 3 == 0 ? -1.0 : 1.0) / k);
  ExactSum up, down, split;
  for (const double term : terms) up.add(term);
  for (std::size_t k = terms.size(); k-- > 0;) down.add(terms[k]);
  EXPECT_EQ(up.total(), down.total());
  for (std::size_t part = 0; part < 7; ++part) {
    ExactSum sum;
    for (std::size_t k = part; k < terms.size(); k += 7) sum.add(terms[k]);
    split.add(sum);
  }
  EXPECT_EQ(split.total(), up.total());
  long double reference = 0.0L;
  for (std::size_t k = 2; k < terms.size(); ++k) reference += static_cast<long double>(terms[k]);
  EXPECT_DOUBLE_EQ(up.total(), static_cast<double>(reference));
}

TEST(ExactSums, LoseNothing) {
  const auto sum_of = [](std::initializer_list<double> terms) {
    ExactSum sum;
    for (const double term : terms) sum.add(term);
    return sum.total();
  };
  EXPECT_EQ(sum_of({}), 0.0);
  EXPECT_EQ(sum_of({1e300, 1.0, -1e300}), 1.0);
  EXPECT_EQ(sum_of({-0x1p-1074}), -0x1p-1074);
  EXPECT_EQ(sum_of({0x1p52, -0x1p-40, -0x1p52}), -0x1p-40);
  EXPECT_EQ(sum_of({std::numeric_limits<double>::max(), -1.0}), std::numeric_limits<double>::max());
  EXPECT_EQ(sum_of({1.0, std::numeric_limits<double>::infinity()}),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace smoothfem
