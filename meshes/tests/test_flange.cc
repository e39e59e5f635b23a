// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/domains/flange.h"

#include "meshes/tests/flange_tests.h"
#include "meshes/tools/sweep.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;

constexpr double tenth = 2.1544;  // edges this much longer give a tenth of the cells

TEST(Flange, HexahedraHaveTheCountsOfTheThesis) {
  const VolumeMesh mesh = generate_flange({ElementType::hexahedron, 1.0});
  expect_flange(mesh, ElementType::hexahedron, 67055, 0.02, 0.002);
  EXPECT_NEAR(static_cast<double>(mesh.n_nodes()), 74730, 0.02 * 74730);
}

class FlangeOfType : public ::testing::TestWithParam<ElementType> {};

TEST_P(FlangeOfType, HasATenthOfTheCells) {
  const double n_cells = GetParam() == ElementType::tetrahedron ? 566004 : 67055;
  const VolumeMesh mesh = generate_flange({GetParam(), tenth});
  expect_flange(mesh, GetParam(), n_cells / 10.0, 0.05, 0.01);
}

TEST_P(FlangeOfType, CanBeCoarserInSmallSteps) {
  for (const double scale : test::short_or_long({3.2, 3.6}, {2.4, 2.8, 3.2, 3.6, 4.0})) {
    SCOPED_TRACE(scale);
    const double n_cells = GetParam() == ElementType::tetrahedron ? 566004 : 67055;
    expect_flange(generate_flange({GetParam(), scale}), GetParam(), n_cells / std::pow(scale, 3),
                  0.1, 0.03);
  }
}

TEST_P(FlangeOfType, TheSameParametersGiveTheSameMesh) {
  expect_same_mesh(generate_flange({GetParam(), 3.0}), generate_flange({GetParam(), 3.0}));
}

INSTANTIATE_TEST_SUITE_P(Types, FlangeOfType,
                         ::testing::Values(ElementType::tetrahedron, ElementType::hexahedron),
                         [](const auto& info) { return std::string(name_of(info.param)); });

TEST(FlangeErrors, NameImpossibleParameters) {
  EXPECT_THAT(input_error_of([] {
                generate_flange({ElementType::prism, 1.0});
              }),
              HasSubstr("tetrahedra or hexahedra only"));
  for (const double scale : {0.5, 4.1, std::nan("")})
    EXPECT_THAT(input_error_of([&] {
                  generate_flange({ElementType::hexahedron, scale});
                }),
                HasSubstr("between 1 and 4"));
  EXPECT_THAT(input_error_of([] { find_domain("flange").generate({.elements = "triangles"}); }),
              HasSubstr("choose one of tetrahedra, hexahedra"));
}

TEST(Domains, FlangeIsAVolumeMesh) {
  const AnyMesh mesh = find_domain("flange").generate({.elements = "hexahedra", .edge_scale = 3.0});
  expect_same_mesh(std::get<VolumeMesh>(mesh), generate_flange({ElementType::hexahedron, 3.0}));
}

TEST(Sweep, ColumnsOfDifferentHeight) {
  PlanarCells base;
  base.coordinates = {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}};
  base.cells.append(std::vector<NodeIndex>{0, 1, 4, 3});
  base.cells.append(std::vector<NodeIndex>{1, 2, 5, 4});
  const VolumeCells swept =
      sweep(base, {0.0, 1.0, 3.0}, [](CellIndex cell) { return cell == 0 ? 1u : 2u; });
  EXPECT_EQ(swept.coordinates.size(), 16u);
  const VolumeMesh mesh(std::make_shared<const Topology>(3, swept.coordinates.size(), swept.cells),
                        swept.coordinates);
  EXPECT_EQ(mesh.n_cells(), 3u);
  EXPECT_EQ(mesh_quality(mesh).n_invalid, 0u);
  EXPECT_DOUBLE_EQ(volume_inside(mesh), 1.0 + 3.0);
}

}  // namespace
}  // namespace smoothfem
