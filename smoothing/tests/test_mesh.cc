// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "smoothing/mesh/parallel_rows.h"
#include "smoothing/tests/planar_meshes.h"

namespace smoothfem {
namespace {

using test::rows_of;
using testing::ElementsAre;
using testing::HasSubstr;

//   3 ---- 4 ---- 5
//   |      |     /
//   |  0   | 1 /        node 6 belongs to no cell
//   0 ---- 1 ---- 2     cell 1: 1 2 4, cell 2: 2 5 4
Topology small_topology() {
  return Topology(2, 7, rows_of({{0, 1, 4, 3}, {1, 2, 4}, {2, 5, 4}}));
}

template <class T>
std::vector<T> as_vector(std::span<const T> values) {
  return {values.begin(), values.end()};
}

TEST(CompressedRows, AreMadeInManyBatches) {
  constexpr std::size_t n = 600000;
  // Short rows come first: the memory reserved for the others is too small.
  const auto length = [](std::size_t i) { return i < n / 2 ? i % 2 : 3 + i % 3; };
  const auto rows = make_rows<std::uint32_t>(n, [&](std::size_t i, auto& row) {
    for (std::size_t k = 0; k < length(i); ++k) row.push_back(static_cast<std::uint32_t>(i + k));
  });
  ASSERT_EQ(rows.size(), n);
  for (std::size_t i = 0; i < n; ++i) {
    ASSERT_EQ(rows[i].size(), length(i)) << i;
    for (std::size_t k = 0; k < length(i); ++k) ASSERT_EQ(rows[i][k], i + k);
  }
  EXPECT_EQ(make_rows<int>(0, [](std::size_t, auto&) {}).size(), 0u);
}

TEST(CompressedRows, RefuseTooManyEntries) {
  constexpr RowOffset half = 1u << 31;
  EXPECT_EQ(row_offsets({0, 2, 0, 3}), (std::vector<RowOffset>{0, 2, 2, 5}));
  EXPECT_NO_THROW(row_offsets({0, half, half - 1}));
  EXPECT_THROW(row_offsets({0, half, half}), InputError);
}

TEST(CompressedRows, KnowTheRowsOfEachEntry) {
  EXPECT_EQ(rows_by_entry(rows_of({{0, 2}, {2, 1}, {2}}), 4), rows_of({{0}, {1}, {0, 1, 2}, {}}));
}

TEST(Topology, Adjacency) {
  const auto topology = small_topology();
  EXPECT_EQ(topology.n_nodes(), 7u);
  EXPECT_EQ(topology.n_cells(), 3u);
  EXPECT_EQ(topology.n_edges(), 8u);
  EXPECT_THAT(as_vector(topology.node_cells(4)), ElementsAre(0, 1, 2));
  EXPECT_THAT(as_vector(topology.node_cells(5)), ElementsAre(2));
  EXPECT_THAT(as_vector(topology.node_cells(6)), ElementsAre());
  EXPECT_THAT(as_vector(topology.node_neighbours(4)), ElementsAre(1, 2, 3, 5));
  EXPECT_THAT(as_vector(topology.node_neighbours(0)), ElementsAre(1, 3));
  EXPECT_EQ(topology.cell_type(0), ElementType::quadrilateral);
  EXPECT_EQ(topology.cell_type(1), ElementType::triangle);
}

TEST(Topology, BoundaryEdgesRunWithTheirCells) {
  EXPECT_EQ(small_topology().boundary_facets(),
            rows_of({{0, 1}, {4, 3}, {3, 0}, {1, 2}, {2, 5}, {5, 4}}));
  EXPECT_EQ(small_topology().n_facets(), 8u);
}

TEST(Topology, FixesBoundaryAndUnusedNodes) {
  const Topology topology(2, 6, rows_of({{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}));
  EXPECT_THAT(topology.free_nodes(), ElementsAre(4));
  EXPECT_TRUE(topology.is_fixed(5));
  EXPECT_FALSE(topology.on_boundary()[5]);
  EXPECT_TRUE(topology.has_free_node(2));
}

TEST(Topology, UsesTheGivenFixedFlags) {
  const Topology topology(2, 4, rows_of({{0, 1, 2}}), std::vector<bool>{true, false, true, false});
  EXPECT_THAT(topology.free_nodes(), ElementsAre(1));
}

void expect_error(std::size_t n_nodes, const test::Cells& cells, const std::string& text,
                  std::optional<std::vector<bool>> fixed = std::nullopt) {
  try {
    Topology(2, n_nodes, rows_of(cells), fixed);
    FAIL() << "nothing thrown; expected: " << text;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(text));
  }
}

TEST(Topology, NamesTheCellThatIsWrong) {
  expect_error(3, {}, "the mesh has no cells");
  expect_error(3, {{0, 1, 2}, {0, 1}}, "cell 1 has 2 nodes; a planar cell needs at least three");
  expect_error(3, {{0, 1, 3}}, "cell 0 names node 3, but the mesh has only 3 nodes");
  expect_error(4, {{0, 1, 2}, {1, 3, 1}}, "cell 1 names node 1 more than once");
  expect_error(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}},
               "cell 2 is cell number 3 at the edge between nodes 0 and 1");
  expect_error(3, {{0, 1, 2}}, "the mesh has 3 nodes but 2 fixed flags", std::vector<bool>(2));
}

TEST(Topology, CellErrorsKnowTheirCell) {
  try {
    Topology(2, 3, rows_of({{0, 1, 2}, {0, 1, 7}}));
    FAIL();
  } catch (const CellError& error) {
    EXPECT_EQ(error.cell(), 1u);
  }
}

TEST(Mesh, RefusesCoordinatesThatDoNotFit) {
  const auto topology = std::make_shared<const Topology>(2, 3, rows_of({{0, 1, 2}}));
  EXPECT_THROW(PlanarMesh(topology, {{0, 0}, {1, 0}}), InputError);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(PlanarMesh(topology, {{0, 0}, {1, 0}, {0, infinity}}), InputError);
}

TEST(Mesh, CopiesShareTheTopologyButNotTheCoordinates) {
  const auto mesh = test::grid_mesh(2, test::GridCells::triangles);
  auto copy = mesh;
  copy.coordinates()[0] = {9, 9};
  EXPECT_EQ(&copy.topology(), &mesh.topology());
  EXPECT_EQ(mesh.copied_coordinates()[0], Point<2>(0, 0));
}

}  // namespace
}  // namespace smoothfem
