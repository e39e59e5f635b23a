// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/hexahedron_templates.h"

#include <map>
#include <set>

#include "meshes/tests/domain_tests.h"
#include "meshes/tools/mesh_cells.h"

namespace smoothfem {
namespace {

VolumeMesh template_mesh(const std::vector<LatticeCell>& cells) {
  VolumeCells mesh;
  std::map<LatticePoint, NodeIndex> numbers;
  for (const LatticeCell& cell : cells) {
    std::vector<NodeIndex> nodes;
    for (const LatticePoint& p : cell) {
      const auto [entry, is_new] =
          numbers.emplace(p, static_cast<NodeIndex>(mesh.coordinates.size()));
      if (is_new) mesh.coordinates.emplace_back(p[0], p[1], p[2]);
      nodes.push_back(entry->second);
    }
    mesh.cells.append(nodes);
  }
  return mesh_of(std::move(mesh), "template");
}

/// Mean ratios in ten-thousandths, rounded.
std::set<long> mean_ratios(const VolumeMesh& mesh) {
  std::set<long> ratios;
  for (const double ratio : cell_mean_ratios(mesh)) ratios.insert(std::lround(1e4 * ratio));
  return ratios;
}

/// Boundary facets on the six sides of the cube: x = 0, x = 3, y = 0, ...
std::vector<int> facets_on_sides(const VolumeMesh& mesh) {
  std::vector<int> counts(6, 0);
  const auto& facets = mesh.topology().boundary_facets();
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (int side = 0; side < 6; ++side) {
      const bool on_side = std::all_of(facets[f].begin(), facets[f].end(), [&](NodeIndex i) {
        return mesh.coordinates()[i][side / 2] == 3.0 * (side % 2);
      });
      counts[static_cast<std::size_t>(side)] += on_side;
    }
  return counts;
}

void expect_fills_the_cube(const VolumeMesh& mesh, std::size_t n_cells) {
  expect_valid(mesh);
  EXPECT_EQ(mesh.n_cells(), n_cells);
  EXPECT_EQ(euler_characteristic(mesh), 1);
  EXPECT_NEAR(volume_inside(mesh), 27.0, 1e-12);
}

TEST(HexahedronTemplates, EdgeHasThePrintedMeanRatios) {
  for (int axis = 0; axis < 3; ++axis) {
    const VolumeMesh mesh = template_mesh(edge_template(axis));
    expect_fills_the_cube(mesh, 5);
    EXPECT_EQ(mean_ratios(mesh), (std::set<long>{6357, 7048, 8399}));
    std::vector<int> sides(6, 1);
    sides[2 * ((axis + 1) % 3)] = sides[2 * ((axis + 2) % 3)] = 4;
    EXPECT_EQ(facets_on_sides(mesh), sides) << axis;
  }
}

TEST(HexahedronTemplates, FaceHasThePrintedMeanRatios) {
  for (int axis = 0; axis < 3; ++axis) {
    const VolumeMesh mesh = template_mesh(face_template(axis));
    expect_fills_the_cube(mesh, 13);
    const auto ratios = mean_ratios(mesh);
    EXPECT_EQ(*ratios.begin(), 5400);
    EXPECT_EQ(*ratios.rbegin(), 10000);
    std::vector<int> sides(6, 4);
    sides[2 * axis] = 9;
    sides[2 * axis + 1] = 1;
    EXPECT_EQ(facets_on_sides(mesh), sides) << axis;
  }
}

TEST(HexahedronTemplates, VolumeAndWholeAreCubes) {
  const VolumeMesh volume = template_mesh(volume_template());
  expect_fills_the_cube(volume, 27);
  EXPECT_EQ(facets_on_sides(volume), std::vector<int>(6, 9));
  const VolumeMesh whole = template_mesh(whole_template());
  expect_fills_the_cube(whole, 1);
  EXPECT_EQ(mean_ratios(volume), mean_ratios(whole));
}

}  // namespace
}  // namespace smoothfem
