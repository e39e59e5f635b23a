// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/mesh_file.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/tests/planar_meshes.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

struct MshVariant {
  std::string name;
  MeshWriteOptions options;
  friend void PrintTo(const MshVariant& parameter, std::ostream* out) { *out << parameter.name; }
};

class MshVariants : public FileTest, public ::testing::WithParamInterface<MshVariant> {};

TEST_P(MshVariants, RoundTripKeepsCellsAndPhysicalNames) {
  const PlanarMesh mesh = mixed_mesh(false, labels_of_mixed_mesh());
  write_mesh(file("a.msh"), mesh, {}, GetParam().options);
  const PlanarFile read = read_planar(file("a.msh"));
  EXPECT_EQ(read.mesh.topology().cells(), mesh.topology().cells());
  EXPECT_EQ(read.mesh.topology().labels(), mesh.topology().labels());
  EXPECT_EQ(read.cell_lines.empty(), GetParam().options.binary.value());
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
  write_mesh(file("a.msh"), mesh, {}, GetParam().options);
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

const std::string head_4 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
const std::string nodes_4 = "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n";

/// Version 4.0: a block starts with its entity's number and dimension, a node has its tag and its
/// coordinates in one line, and points have a box. Nodes 7 and 9 belong to a curve, with a
/// parametric coordinate. Two triangles belong to a surface in the group "sheet", one to a surface
/// in no group.
const std::string head_4_0 = "$MeshFormat\n4 0 8\n$EndMeshFormat\n";
std::string sheet_4_0(const std::string& last_node = "9 1 1 0 .75",
                      const std::string& last_element = "12 7 9 4") {
  return head_4_0 +
         "$PhysicalNames\n1\n2 6 \"sheet\"\n$EndPhysicalNames\n"
         "$Entities\n1 1 2 0\n1 0 0 0 0 0 0 1 8\n5 1 0 0 1 1 0 0 2 1 -1\n"
         "3 0 0 0 1 1 0 1 6 1 5\n4 0 0 0 1 1 0 0 1 5\n$EndEntities\n"
         "$Nodes\n3 5\n3 2 0 2\n4 0 1 0\n2 0 0 0\n4 2 0 1\n5 .5 2 0\n5 1 1 2\n7 1 0 0 .25\n" +
         last_node +
         "\n$EndNodes\n$Elements\n3 4\n1 0 15 1\n1 2\n4 2 2 1\n20 4 9 5\n3 2 2 2\n11 2 7 4\n" +
         last_element + "\n$EndElements\n";
}

/// Two triangles, the second in line 16, with gaps in the nodes' tags and one node of no cell.
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

TEST_F(Msh, AllowsUnusedNodes) {
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

TEST_F(Msh, TagsOfVersion2AreThoseOfTheElementsNotOfTheirEntity) {
  const PlanarFile read = read_planar(file_with("a.msh", square("9 0 1 0", "12 2 3 4 1 0 2 7 9")));
  EXPECT_EQ(read.mesh.topology().labels().cell_tags, (std::vector<int>{1, 4}));
}

TEST_F(Msh, ElementsNeedNoTags) {
  const PlanarFile read = read_planar(file_with("a.msh", square("9 0 1 0", "12 2 0 2 7 9")));
  EXPECT_EQ(read.mesh.topology().labels().cell_tags, (std::vector<int>{1, 0}));
}

/// Their entity is in two groups. The first one is the cells' tag, and the names of both are kept.
TEST_F(Msh, EntitiesOfVersion4MayBeInSeveralGroupsAndOnSeveralLines) {
  const std::string names =
      "$PhysicalNames\n4\n2 3 \"three\"\n2 7 \"seven\"\n2 9 \"nine\"\n2 3 \"drei\"\n"
      "$EndPhysicalNames\n";
  const std::string entities =
      "$Entities\n1 1 1\n 0\n1 0 0 0 1 2\n1 0 0 0 1 0 0 0 2 1 -1\n1 0 0 0 1 1\n 0 2 7 3 1 -1\n"
      "$EndEntities\n";
  const PlanarFile read =
      read_planar(file_with("a.msh", head_4 + names + entities + nodes_4 +
                                         "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n"));
  const MeshLabels& labels = read.mesh.topology().labels();
  EXPECT_EQ(labels.cell_tags, (std::vector<int>{7}));
  EXPECT_EQ(labels.names,
            (decltype(labels.names){{{2, 3}, "three"}, {{2, 7}, "seven"}, {{2, 9}, "nine"}}));
}

TEST_F(Msh, PartitionsAreReadWithTheGroupsOfTheirEntities) {
  const std::string partitions =
      "$PartitionedEntities\n2\n1\n9 1\n0 0 2 0\n1 2 5 1 1 0 0 0 1 1 0 1 8 0\n"
      "2 2 5 2 1 2 0 0 0 1 1 0 0 0\n$EndPartitionedEntities\n";
  const std::string nodes =
      "$Nodes\n1 4 1 4\n2 1 0 4\n4\n3\n2\n1\n0 1 0\n1 1 0\n1 0 0\n0 0 0\n$EndNodes\n";
  const PlanarFile read = read_planar(
      file_with("a.msh", head_4 + partitions + nodes +
                             "$Elements\n2 2 1 2\n2 2 2 1\n2 1 3 4\n2 1 2 1\n1 1 2 3\n"
                             "$EndElements\n$GhostElements\n1\n1 1 1 2\n$EndGhostElements\n"));
  EXPECT_EQ(read.mesh.topology().labels().cell_tags, (std::vector<int>{8, 0}));
  EXPECT_EQ(read.mesh.topology().cells().entries(), (std::vector<NodeIndex>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(read.mesh.copied_coordinates()[2], Point<2>(1, 1));
  EXPECT_EQ(read.cell_lines, (std::vector<std::size_t>{29, 27}));
  const MeshFile file_read = read_mesh(file("a.msh"));
  EXPECT_THAT(file_read.notes, ::testing::ElementsAre("the division into partitions with its ghost "
                                                      "elements is left out"));
  write_mesh(file("b.msh"), file_read.mesh);
  EXPECT_THAT(content_of(file("b.msh")), ::testing::Not(HasSubstr("Ghost")));
}

/// As some programs write version 2: all of it is read by Gmsh.
TEST_F(Msh, ReadsVersion2InOtherHands) {
  const std::string expected = content_of(file_with("a.msh", square()));
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = expected;
    text.replace(text.find(from), from.size(), to);
    return file_with("a.msh", text);
  };
  for (const std::string version : {"2", "2.0", "2.200000"})
    EXPECT_EQ(read_planar(changed("2.2 0", version + " 0")).mesh.n_cells(), 2u) << version;
  EXPECT_EQ(read_planar(changed("$Nodes\n", "$Nodes\n  \t ")).mesh.n_cells(), 2u);
  const PlanarFile commented =
      read_planar(changed("$MeshFormat", "$Comments\nof 1\n$EndComments\n$MeshFormat"));
  EXPECT_EQ(commented.mesh.n_cells(), 2u);
  write_mesh(file("b.msh"), commented.mesh);
  EXPECT_THAT(content_of(file("b.msh")), HasSubstr("$Comments\nof 1\n$EndComments\n"));
  const PlanarFile named = read_planar(changed(
      "$Nodes\n", "$PhysicalNames\n2\n1 \"a sheet\"\n7 \"none\"\n$EndPhysicalNames\n$Nodes\n"));
  const auto& names = named.mesh.topology().labels().names;
  EXPECT_EQ(names.at({2, 1}), "a sheet");
  EXPECT_EQ(names.at({2, 7}), "none");
  EXPECT_EQ(names.size(), 2u);
  const auto with_third_tag = [&](const std::string& tag) {
    return changed("11 2 2 1 1 2 3 7", "11 2 3 1 1 " + tag + " 2 3 7");
  };
  EXPECT_EQ(read_mesh(with_third_tag("0")).notes.size(), 1u);  // on the node of no cell
  EXPECT_EQ(read_mesh(with_third_tag("4")).notes.size(), 2u);
}

TEST_F(Msh, Version4_0IsRead) {
  for (const std::string version : {"4", "4.0"}) {
    std::string content = sheet_4_0();
    content.replace(content.find("\n4 0 8") + 1, 1, version);
    const PlanarFile read = read_planar(file_with("a.msh", content));
    const std::vector<Point<2>> expected = {{0, 0}, {0, 1}, {.5, 2}, {1, 0}, {1, 1}};
    EXPECT_EQ(read.mesh.copied_coordinates(), expected);
    EXPECT_EQ(read.mesh.topology().cells().entries(),
              (std::vector<NodeIndex>{0, 3, 1, 3, 4, 1, 1, 4, 2}));
    const MeshLabels& labels = read.mesh.topology().labels();
    EXPECT_EQ(labels.cell_tags, (std::vector<int>{6, 6, 0}));
    EXPECT_EQ(labels.cell_ids, (std::vector<std::size_t>{11, 12, 20}));
    EXPECT_EQ(labels.node_ids, (std::vector<std::size_t>{2, 4, 5, 7, 9}));
    EXPECT_EQ(labels.names, (decltype(labels.names){{{2, 6}, "sheet"}}));
  }
}

TEST_F(Msh, PartitionsOfVersion4_0AreReadWithTheGroupsOfTheirEntities) {
  const std::string partitions =
      "$PartitionedEntities\n2\n0\n1 0 2 0\n7 0 1 2 1 2 0 0 0 0 0 0 1 4\n"
      "1 2 5 1 1 0 0 0 1 1 0 1 8 0\n2 2 5 1 2 0 0 0 1 1 0 0 0\n$EndPartitionedEntities\n";
  const PlanarFile read = read_planar(
      file_with("a.msh", head_4_0 + partitions +
                             "$Nodes\n1 4\n1 2 0 4\n4 0 1 0\n3 1 1 0\n2 1 0 0\n1 0 0 0\n$EndNodes\n"
                             "$Elements\n2 2\n2 2 2 1\n2 1 3 4\n1 2 2 1\n1 1 2 3\n$EndElements\n"));
  EXPECT_EQ(read.mesh.topology().labels().cell_tags, (std::vector<int>{8, 0}));
  EXPECT_EQ(read.mesh.topology().cells().entries(), (std::vector<NodeIndex>{0, 1, 2, 0, 2, 3}));
}

/// The file is cut off at every position, in the middle of a line or not.
TEST_F(Msh, RefusesVersion4_0CutOffAnywhere) {
  const std::string content = sheet_4_0();
  for (std::size_t size = 0; size + 1 < content.size(); ++size) {
    const auto path = file_with("a.msh", content.substr(0, size));
    EXPECT_THAT(input_error_of([&] { read_mesh(path); }), StartsWith(path.string() + ":"))
        << content.substr(0, size);
  }
}

TEST_F(Msh, SkipsOtherSectionsWithAnyCounts) {
  const std::string others =
      "$Comments\n$Nodes are below\n$EndComments\n$NodeData\n1\n\"x\"\n1\n0\n3\n0\n1\n1000000000\n"
      "1 2\n$EndNodeData\n$Periodic\n1000000000\n$EndPeriodic\n$Whatever\n$EndWhatever\n";
  std::string content = square();
  content.insert(head_2.size(), others);
  content += others;
  EXPECT_EQ(read_planar(file_with("a.msh", content)).mesh.n_cells(), 2u);
}

TEST_P(MshVariants, NumbersAreKeptIfTheVersionHasThem) {
  MeshLabels labels = labels_of_mixed_mesh();
  for (std::size_t i = 0; i < 10; ++i) labels.node_ids.push_back(100 - 9 * i);
  labels.cell_ids = {12, 5, 7, 70, 6, 900};
  const PlanarMesh mesh = mixed_mesh(false, labels);
  write_mesh(file("a.msh"), mesh, {}, GetParam().options);
  // Nodes and cells come in the order of their numbers.
  const PlanarFile read = read_planar(file("a.msh"));
  std::reverse(labels.node_ids.begin(), labels.node_ids.end());
  EXPECT_EQ(read.mesh.topology().labels().node_ids, labels.node_ids);
  EXPECT_EQ(read.mesh.topology().labels().cell_ids,
            (std::vector<std::size_t>{5, 6, 7, 12, 70, 900}));
  EXPECT_EQ(read.mesh.copied_coordinates()[9], mesh.copied_coordinates()[0]);
  labels.cell_ids[2] = 5'000'000'000;
  const auto write = [&] {
    write_mesh(file("b.msh"), mixed_mesh(false, labels), {}, GetParam().options);
  };
  if (GetParam().options.msh_version == MshVersion::v2_2) {
    EXPECT_THAT(input_error_of(write), HasSubstr("the number 5000000000 does not fit into 32"));
    return;
  }
  write();
  EXPECT_EQ(read_planar(file("b.msh")).mesh.topology().labels().cell_ids.back(), 5'000'000'000u);
}

TEST_F(Msh, ReadsClockwiseCellsThatRequireValidNames) {
  const auto path = file_with("a.msh", square("9 0 1 0", "12 2 2 1 1 2 9 7"));
  const PlanarFile read = read_planar(path, {.turns_over = false});
  EXPECT_THAT(input_error_of([&] { require_valid(read.mesh, path.string(), read.cell_lines); }),
              ::testing::AllOf(StartsWith(path.string() + ":16: "), HasSubstr("clockwise")));
}

/// Plain numbers are not kept, but messages have them.
TEST_F(Msh, MessagesNumberCellsAsTheFileDoes) {
  const auto numbers = [&](const std::string& first, const std::string& second) {
    std::string content = square("9 0 1 0", second + " 2 2 1 1 2 7 9");
    content.replace(content.find("10 15 2"), 2, "3");
    content.replace(content.find("11 2 2"), 2, first);
    const PlanarFile read = read_planar(file_with("a.msh", content));
    const MeshLabels& labels = read.mesh.topology().labels();
    return std::vector{labels.cell_number(0), labels.cell_number(1)};
  };
  EXPECT_THAT(numbers("1", "2"), ::testing::ElementsAre(1, 2));
  EXPECT_THAT(numbers("11", "12"), ::testing::ElementsAre(11, 12));
  EXPECT_EQ(test::grid_mesh(1, test::GridCells::triangles).topology().labels().cell_number(0), 0u);
}

struct BadMsh {
  std::string name, content, message;
  friend void PrintTo(const BadMsh& parameter, std::ostream* out) { *out << parameter.name; }
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

const std::string third_order = head_2 +
                                "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n"
                                "1\n1 21 2 1 1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n";

INSTANTIATE_TEST_SUITE_P(
    Msh, BadMshFile,
    ::testing::Values(
        BadMsh{"other_file", "solid cube\n", ":1: the first line is not '$MeshFormat'"},
        BadMsh{"version", "$MeshFormat\n3 0 8\n$EndMeshFormat\n", ":2: the file has version '3'"},
        BadMsh{"binary_4_0", "$MeshFormat\n4 1 8\n",
               ":2: the file has version '4' and is binary; save it as text, or as version 4.1"},
        BadMsh{"few_nodes_4_0", head_4_0 + "$Nodes\n1 2\n3 2 0 2\n1 0 0 0\n$EndNodes\n",
               ":8: the node's tag is '$EndNodes'"},
        BadMsh{"total_of_nodes_4_0", head_4_0 + "$Nodes\n1 2\n3 2 0 1\n1 0 0 0\n$EndNodes\n",
               "announces 2 nodes but has 1"},
        BadMsh{"order_of_4_1_in_4_0", head_4_0 + "$Nodes\n1 1 1 1\n2 3 0 1\n1\n0 0 0\n$EndNodes\n",
               ":5: unexpected '1' at the end of the line"},
        BadMsh{"no_parameter_4_0", sheet_4_0("9 1 1 0"), "a parametric coordinate is missing"},
        BadMsh{"missing_node_4_0", sheet_4_0("9 1 1 0 .75", "12 7 9 8"),
               "element 12 names node 8, which the file does not have"},
        BadMsh{"few_element_nodes_4_0", sheet_4_0("9 1 1 0 .75", "12 7 9"),
               "element 12 has 2 nodes, but those of Gmsh's type 2 have 3"},
        BadMsh{"node_tag_twice_4_0", sheet_4_0("7 1 1 0 .75"), "the node tag 7 appears twice"},
        BadMsh{"dimension_of_nodes_4_0", head_4_0 + "$Nodes\n1 1\n2 4 0 1\n1 0 0 0\n$EndNodes\n",
               ":6: the entity's dimension is 4, but must be from 0 to 3"},
        BadMsh{"no_nodes", head_2, "the file has no section $Nodes"},
        BadMsh{"no_elements", head_4 + nodes_4, "the file has no section $Elements"},
        BadMsh{"too_few_nodes", head_2 + "$Nodes\n3\n1 0 0 0\n$EndNodes\n",
               ":7: the node's tag is '$EndNodes'"},
        BadMsh{"too_many_nodes", head_2 + "$Nodes\n1\n1 0 0 0\n2 1 0 0\n$EndNodes\n",
               ":7: expected $EndNodes"},
        BadMsh{"nan", square("9 0 nan 0"), ":10: the node's y coordinate is 'nan'"},
        BadMsh{"missing_node", square("9 0 1 0", "12 2 2 1 1 2 7 8"),
               ":16: element 12 names node 8, which the file does not have"},
        BadMsh{"too_few_element_nodes", square("9 0 1 0", "12 2 2 1 1 2 7"),
               ":16: element 12 has 2 nodes, but those of Gmsh's type 2 have 3"},
        BadMsh{"too_many_element_nodes", square("9 0 1 0", "12 2 2 1 1 2 7 9 3"),
               ":16: unexpected '3' at the end of the line"},
        BadMsh{"few_tags", square("9 0 1 0", "12 2 4 1 1"), ":16: the element's line ends before"},
        BadMsh{"wide_tag", square("9 0 1 0", "12 2 2 3000000000 1 2 7 9"),
               ":16: the element's line holds '3000000000', which is not an integer of 32 bits"},
        BadMsh{"same_element_tag_twice", square("9 0 1 0", "11 2 2 1 1 2 7 9"),
               ":16: the element tag 11 appears twice"},
        BadMsh{"nodes_twice", square() + "$Nodes\n0\n$EndNodes\n",
               ":18: there is a second section $Nodes"},
        BadMsh{"elements_first",
               head_2 + "$Elements\n1\n1 2 0 1 2 3\n$EndElements\n$Nodes\n1\n1 0 0 0\n$EndNodes\n",
               ":6: element 1 names node 1, which the file does not have"},
        BadMsh{"parametric_nodes", head_2 + "$ParametricNodes\n0\n$EndParametricNodes\n",
               ":4: the nodes have parametric coordinates; save the mesh without them"},
        BadMsh{"dimension_of_name", square() + "$PhysicalNames\n1\n4 1 \"x\"\n$EndPhysicalNames\n",
               ":20: the physical group's dimension is 4, but must be from 0 to 3"},
        BadMsh{"more_names", square() + "$PhysicalNames\n0\n2 1 \"x\"\n$EndPhysicalNames\n",
               ":20: expected $EndPhysicalNames"},
        BadMsh{"no_end_of_data", square() + "$NodeData\n1\n\"x\"\n",
               ":20: the file ends before $EndNodeData; it is truncated"},
        BadMsh{"node_twice", square("9 0 1 0", "12 2 2 1 1 2 7 7"),
               ":16: cell 1 names node 7 more than once; give the cell different nodes"},
        BadMsh{"element_junk", square("9 0 1 0", "12 2 2 1 1 2 7 x"),
               ":16: the element's line holds 'x'"},
        BadMsh{"same_node_tag_twice", square("7 0 1 0"), ":10: the node tag 7 appears twice"},
        BadMsh{"third_order", third_order,
               ":12: the mesh has elements of Gmsh's type 21, but only points and lines, "},
        BadMsh{"third_order_advice", third_order, "save it with element order 1 or 2"},
        BadMsh{"only_points",
               head_2 + "$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 15 2 0 1 1\n$EndElements\n",
               "the mesh has no cells"},
        BadMsh{"block_total_4",
               head_4 + nodes_4 + "$Elements\n1 2 1 2\n2 1 2 1\n1 1 2 3\n$EndElements\n",
               "announces 2 elements but has 1"},
        BadMsh{"dimension_of_block_4",
               head_4 + nodes_4 + "$Elements\n1 1 1 1\n3 1 2 1\n1 1 2 3\n$EndElements\n",
               ":16: the block's entity has dimension 3, its elements have 2"},
        BadMsh{"dimension_of_nodes_4", head_4 + "$Nodes\n1 1 1 1\n4 1 0 1\n1\n0 0 0\n$EndNodes\n",
               ":6: the entity's dimension is 4, but must be from 0 to 3"},
        BadMsh{"total_of_nodes_4", head_4 + "$Nodes\n1 2 1 1\n2 1 0 1\n1\n0 0 0\n$EndNodes\n",
               "announces 2 nodes but has 1"},
        BadMsh{"entities_4", head_4 + "$Entities\n0 0 1 0\n1 0 0 0\n1 1 0 9 1 2\n$EndEntities\n",
               ":8: the entity's line holds '$EndEntities', which is not an integer"},
        BadMsh{"bytes_of_numbers", "$MeshFormat\n4.1 1 4\n", ":2: the file's numbers have 4 bytes"},
        BadMsh{"byte_order", "$MeshFormat\n4.1 1 8\nABCD\n$EndMeshFormat\n",
               "at byte 24: the number that shows the byte order is 1145258561 instead of 1"},
        BadMsh{"missing_node_4",
               head_4 + nodes_4 + "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 4\n$EndElements\n",
               "element 1 names node 4"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace smoothfem
