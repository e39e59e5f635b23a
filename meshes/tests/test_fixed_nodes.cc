// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tests/mesh_tests.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;

/// A 2 x 2 x 2 box, one inner node; the facets of its bottom have tag 5, one of its top tag 2.
VolumeMesh box() {
  const VolumeMesh mesh = test::box_mesh(2, 2, 2, test::BoxCells::hexahedra);
  MeshLabels labels;
  labels.facets.append(std::vector<NodeIndex>{0, 3, 4, 1});
  labels.facets.append(std::vector<NodeIndex>{1, 4, 5, 2});
  labels.facets.append(std::vector<NodeIndex>{18, 19, 22, 21});
  labels.facet_tags = {5, 5, 2};
  labels.names = {{{2, 5}, "inlet"}, {{3, 2}, "air"}};
  std::vector<bool> fixed(mesh.n_nodes(), false);
  fixed[13] = true;
  return {
      std::make_shared<const Topology>(3, mesh.n_nodes(), mesh.topology().cells(), fixed, labels),
      mesh.copied_coordinates()};
}

std::vector<NodeIndex> fixed_by(const std::string& rule) {
  const auto fixed = fixed_nodes(box().topology(), parse_fixed_nodes_rule(rule));
  std::vector<NodeIndex> nodes;
  for (NodeIndex i = 0; i < fixed.size(); ++i)
    if (fixed[i]) nodes.push_back(i);
  return nodes;
}

using Nodes = std::vector<NodeIndex>;

TEST(FixedNodes, FollowTheRule) {
  EXPECT_EQ(fixed_by("boundary").size(), 26u);
  EXPECT_EQ(fixed_by("file"), Nodes{13});
  EXPECT_EQ(fixed_by("free"), Nodes{});
  // Groups add to what stays by default.
  EXPECT_EQ(fixed_by("group=5"), (Nodes{0, 1, 2, 3, 4, 5, 13}));
  EXPECT_EQ(fixed_by("group=inlet"), (Nodes{0, 1, 2, 3, 4, 5, 13}));
  EXPECT_EQ(fixed_by("group=inlet,2"), (Nodes{0, 1, 2, 3, 4, 5, 13, 18, 19, 21, 22}));
}

TEST(FixedNodes, RefusesUnknownGroupsAndRulesAndListsTheAvailableOnes) {
  EXPECT_EQ(input_error_of([] { fixed_by("group=outlet"); }),
            "no boundary group is called 'outlet'; the mesh has the groups 2, 5 (inlet)");
  EXPECT_THAT(input_error_of([] { fixed_by("group="); }), HasSubstr("use boundary, file, free"));
  EXPECT_THAT(input_error_of([] { fixed_by("all"); }), HasSubstr("'all'"));
  const Topology unlabelled(3, 4, test::rows_of({{0, 1, 2, 3}}));
  EXPECT_THAT(input_error_of([&] { fixed_nodes(unlabelled, parse_fixed_nodes_rule("group=1")); }),
              HasSubstr("the mesh has no labelled boundary groups"));
}

TEST(FixedNodes, KeepsUnusedNodesFixedAndLabels) {
  const VolumeMesh mesh = test::make_volume_mesh(
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {9, 9, 9}}, test::rows_of({{0, 1, 2, 3}}));
  const auto fixed = fixed_nodes(mesh.topology(), parse_fixed_nodes_rule("free"));
  EXPECT_EQ(fixed, (std::vector<FixedReasons>{0, 0, 0, 0, bit(FixedReason::unused)}));
  EXPECT_EQ(with_fixed_nodes(mesh, fixed).topology().free_nodes(), (Nodes{0, 1, 2, 3}));
  const VolumeMesh other = with_fixed_nodes(box(), std::vector<bool>(27, false));
  EXPECT_EQ(other.topology().labels(), box().topology().labels());
  EXPECT_EQ(other.topology().free_nodes().size(), 27u);
}

}  // namespace
}  // namespace smoothfem
