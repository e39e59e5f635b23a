// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "smoothing/laplacian/cells_around_nodes.h"
#include "smoothing/tests/planar_meshes.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

/// Compares with the tables of the topology, also without room for a table.
template <int dim>
void expect_cells_of_topology(const Mesh<dim>& mesh) {
  const Topology& topology = mesh.topology();
  for (const std::size_t max_entries : {CellsAroundNodes::default_max_entries, std::size_t{0}}) {
    CellsAroundNodes around(max_entries);
    around.prepare(mesh.shared_topology());
    for (std::size_t i = 0; i < topology.free_nodes().size(); ++i) {
      const auto expected = topology.node_cells(topology.free_nodes()[i]);
      around.with_cells(i, [&](const auto& cells) {
        ASSERT_EQ(cells.size(), expected.size());
        for (std::size_t position = 0; position < expected.size(); ++position) {
          EXPECT_EQ(cells.number(position), expected[position]);
          EXPECT_THAT(cells.nodes(position),
                      testing::ElementsAreArray(topology.cell_nodes(expected[position])));
        }
      });
    }
  }
}

TEST(CellsAroundNodes, AreThoseOfTheTopology) {
  for (const auto kind : {test::GridCells::triangles, test::GridCells::mixed})
    expect_cells_of_topology(test::grid_mesh(7, kind));
  expect_cells_of_topology(test::pentagon_mesh());
  for (const auto kind :
       {test::BoxCells::tetrahedra, test::BoxCells::hexahedra, test::BoxCells::mixed})
    expect_cells_of_topology(test::box_mesh(4, 4, 4, kind));
}

TEST(CellsAroundNodes, BelongToTheMeshOfTheLastPreparation) {
  CellsAroundNodes around;
  for (const std::uint32_t n : {3, 5}) {
    const PlanarMesh mesh = test::grid_mesh(n, test::GridCells::quadrilaterals);
    around.prepare(mesh.shared_topology());
    const std::size_t last = mesh.topology().free_nodes().size() - 1;
    around.with_cells(last, [&](const auto& cells) {
      EXPECT_THAT(cells.nodes(3),
                  testing::ElementsAreArray(mesh.topology().cell_nodes(cells.number(3))));
    });
  }
}

}  // namespace
}  // namespace smoothfem
