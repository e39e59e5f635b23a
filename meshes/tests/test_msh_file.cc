// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/mesh_file.h"
#include "meshes/tests/mesh_tests.h"
#include "meshes/tools/gmsh_session.h"
#include "smoothing/base/parallel.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

struct MshVariant {
  std::string name;
  MeshWriteOptions options;
};

class MshVariants : public FileTest, public ::testing::WithParamInterface<MshVariant> {};

MeshLabels labels_of_mixed_mesh() {
  MeshLabels labels;
  labels.cell_tags = {7, 7, 3, 3, 7, 3};
  labels.facets.append(std::vector<NodeIndex>{1, 2});
  labels.facets.append(std::vector<NodeIndex>{0, 1});
  labels.facet_tags = {5, 4};
  labels.names = {{{2, 7}, "steel"}, {{2, 3}, "air gap"}, {{1, 5}, "inlet"}};
  return labels;
}

TEST_P(MshVariants, RoundTripKeepsCellsAndPhysicalNames) {
  const PlanarMesh mesh = mixed_mesh(false, labels_of_mixed_mesh());
  write_mesh(file("a.msh"), mesh, {}, GetParam().options);
  const PlanarFile read = read_planar(file("a.msh"));
  EXPECT_EQ(read.mesh.topology().cells(), mesh.topology().cells());
  EXPECT_EQ(read.mesh.topology().labels(), mesh.topology().labels());
  EXPECT_EQ(read.cell_lines.empty(), GetParam().options.msh_binary);
  EXPECT_EQ(read.mesh.copied_coordinates(), mesh.copied_coordinates());  // bit by bit
}

TEST_P(MshVariants, RoundTripWithoutLabels) {
  write_mesh(file("a.msh"), mixed_mesh(false), {}, GetParam().options);
  const PlanarFile read = read_planar(file("a.msh"));
  EXPECT_EQ(read.mesh.topology().cells(), mixed_mesh(false).topology().cells());
  EXPECT_EQ(read.mesh.topology().labels(), MeshLabels());
}

TEST_P(MshVariants, CellsInPartWithoutTag) {
  MeshLabels labels = labels_of_mixed_mesh();
  labels.cell_tags[1] = 0;
  const PlanarMesh mesh = mixed_mesh(false, labels);
  const auto write = [&] { write_mesh(file("a.msh"), mesh, {}, GetParam().options); };
  if (GetParam().options.msh_version == MshVersion::v2_2) {
    EXPECT_THAT(input_error_of(write), HasSubstr("which version 2.2 cannot hold; use 4.1"));
    return;
  }
  write();
  EXPECT_EQ(read_planar(file("a.msh")).mesh.topology().labels(), labels);
}

INSTANTIATE_TEST_SUITE_P(Msh, MshVariants,
                         ::testing::Values(MshVariant{"v41_binary", {MshVersion::v4_1, true}},
                                           MshVariant{"v41_text", {MshVersion::v4_1, false}},
                                           MshVariant{"v22_binary", {MshVersion::v2_2, true}},
                                           MshVariant{"v22_text", {MshVersion::v2_2, false}}),
                         [](const auto& info) { return info.param.name; });

using Msh = FileTest;

const std::string head_2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";

/// Two triangles, the second in line 16, on nodes with gaps in their tags and one node of no cell.
std::string square(const std::string& last_node = "9 0 1 0",
                   const std::string& last_element = "12 2 2 1 1 2 7 9") {
  return head_2 + "$Nodes\n5\n2 0 0 0\n3 1 0 0\n5 5 5 0\n7 1 1 0\n" + last_node +
         "\n$EndNodes\n$Elements\n3\n10 15 2 0 1 5\n11 2 2 1 1 2 3 7\n" + last_element +
         "\n$EndElements\n";
}

TEST_F(Msh, NodesAreNumberedFromZeroWithoutUnusedOnes) {
  const PlanarFile read = read_planar(file_with("a.msh", square()));
  const std::vector<Point<2>> expected = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  EXPECT_EQ(read.mesh.copied_coordinates(), expected);
  EXPECT_EQ(read.mesh.topology().cells().entries(), (std::vector<NodeIndex>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(read.mesh.topology().labels().cell_tags, (std::vector<int>{1, 1}));
  EXPECT_EQ(read.cell_lines, (std::vector<std::size_t>{15, 16}));
}

TEST_F(Msh, NodesThatNothingUsesAreAllowed) {
  std::string content = square();
  content.replace(content.find("15 2 0 1 5"), 10, "15 2 0 1 3");
  EXPECT_EQ(read_planar(file_with("a.msh", content)).mesh.n_nodes(), 4u);
}

TEST_F(Msh, ConstantZIsPlanarWhateverItsValue) {
  std::string content = square();
  for (const std::string node : {"0 0 0\n", "1 0 0\n", "5 5 0\n", "1 1 0\n", "0 1 0\n"})
    content.replace(content.find(node) + 4, 1, "2.5");
  EXPECT_EQ(read_planar(file_with("a.msh", content)).mesh.n_cells(), 2u);
}

TEST_F(Msh, ClockwiseCellsAreReadAndNamedByRequireValid) {
  const auto path = file_with("a.msh", square("9 0 1 0", "12 2 2 1 1 2 9 7"));
  const PlanarFile read = read_planar(path);
  EXPECT_THAT(input_error_of([&] { require_valid(read.mesh, path.string(), read.cell_lines); }),
              ::testing::AllOf(StartsWith(path.string() + ":16: "), HasSubstr("clockwise")));
}

struct BadMsh {
  std::string name, content, message;
};

class BadMshFile : public FileTest, public ::testing::WithParamInterface<BadMsh> {};

TEST_P(BadMshFile, IsRefusedWithReasonAndNothingOnTheTerminal) {
  const auto path = file_with("bad.msh", GetParam().content);
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const std::string message = input_error_of([&] { read_planar(path); });
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_THAT(message, StartsWith(path.string() + ":"));
  EXPECT_THAT(message, HasSubstr(GetParam().message));
}

const std::string head_4 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
const std::string nodes_4 = "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n";
const std::string second_order =
    head_2 +
    "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 .5 0 0\n5 .5 .5 0\n6 0 .5 0\n$EndNodes\n$Elements\n"
    "1\n1 9 2 1 1 1 2 3 4 5 6\n$EndElements\n";

INSTANTIATE_TEST_SUITE_P(
    Msh, BadMshFile,
    ::testing::Values(
        BadMsh{"other_file", "solid cube\n", ":1: the first line is not '$MeshFormat'"},
        BadMsh{"version", "$MeshFormat\n4 0 8\n$EndMeshFormat\n", ":2: the file has version '4'"},
        BadMsh{"no_nodes", head_2, "the file has no section $Nodes"},
        BadMsh{"no_elements", head_4 + nodes_4, "the file has no section $Elements"},
        BadMsh{"too_few_nodes", head_2 + "$Nodes\n3\n1 0 0 0\n$EndNodes\n",
               ":7: the node's tag is '$EndNodes'"},
        BadMsh{"too_many_nodes", head_2 + "$Nodes\n1\n1 0 0 0\n2 1 0 0\n$EndNodes\n",
               ":7: expected $EndNodes"},
        BadMsh{"nan", square("9 0 nan 0"), ":10: the node's y coordinate is 'nan'"},
        BadMsh{"missing_node", square("9 0 1 0", "12 2 2 1 1 2 7 8"),
               ":16: element 12 names node 8, which the file does not have"},
        BadMsh{"too_few_element_nodes", square("9 0 1 0", "12 2 2 1 1 2 7"), "Gmsh"},
        BadMsh{"node_twice", square("9 0 1 0", "12 2 2 1 1 2 7 7"),
               ":16: cell 1 names node 2 more than once"},
        BadMsh{"element_junk", square("9 0 1 0", "12 2 2 1 1 2 7 x"),
               ":16: the element's line holds 'x'"},
        BadMsh{"same_node_tag_twice", square("7 0 1 0"), ":10: the node tag 7 appears twice"},
        BadMsh{"second_order", second_order, "save it with element order 1"},
        BadMsh{"only_points",
               head_2 + "$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 15 2 0 1 1\n$EndElements\n",
               "the mesh has no cells"},
        BadMsh{"block_total_4",
               head_4 + nodes_4 + "$Elements\n1 2 1 2\n2 1 2 1\n1 1 2 3\n$EndElements\n",
               "announces 2 elements but has 1"},
        BadMsh{"missing_node_4",
               head_4 + nodes_4 + "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 4\n$EndElements\n",
               "element 1 names node 4"}),
    [](const auto& info) { return info.param.name; });

TEST_F(Msh, SessionsLeaveTheNumberOfThreadsAlone) {
  for (const int threads : {3, 2}) {
    set_n_threads(threads);
    { const GmshSession session; }
    EXPECT_EQ(n_threads(), threads);
  }
}

TEST_F(Msh, SessionsMayBeNestedAndKeepOptionsApart) {
  GmshSession outer;
  outer.set_option("Mesh.SaveAll", 1);
  write_mesh(file("a.msh"), mixed_mesh(false, labels_of_mixed_mesh()), {},
             {MshVersion::v2_2, false});
  const PlanarFile read = read_planar(file("a.msh"));
  EXPECT_EQ(read.mesh.topology().labels(), labels_of_mixed_mesh());
  EXPECT_THAT(input_error_of([&] { outer.run("here", [] { throw std::string("words"); }); }),
              "here: Gmsh: words");
}

}  // namespace
}  // namespace smoothfem
