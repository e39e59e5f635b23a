// SPDX-License-Identifier: GPL-3.0-or-later
/// What a file says comes out as it went in.
#include "meshes/io/losses.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/mesh/fixed_nodes.h"

namespace smoothfem {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

/// Two squares side by side. The right one is in two groups, and so is the left edge; it has a
/// periodic partner. The bottom edges have no group; there is a labelled point; node and element
/// data; a section that smoothfem does not know.
const std::string all_41 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n5\n0 9 \"sensor\"\n1 1 \"clamped\"\n1 2 \"grounded\"\n2 3 \"solid\"\n"
    "2 4 \"source\"\n$EndPhysicalNames\n"
    "$Entities\n1 3 2 0\n"
    "5 1 0 0 1 9\n"
    "10 0 0 0 0 1 0 2 1 2 1 5\n11 2 0 0 2 1 0 0 0\n12 0 0 0 2 0 0 0 0\n"
    "21 0 0 0 1 1 0 1 3 2 10 -12\n22 1 0 0 2 1 0 2 3 4 0\n$EndEntities\n"
    "$Nodes\n3 6 1 6\n1 10 0 2\n1\n4\n0 0 0\n0 1 0\n2 21 0 2\n2\n5\n1 0 0\n1 1 0\n"
    "2 22 0 2\n3\n6\n2 0 0\n2 1 0\n$EndNodes\n"
    "$Elements\n6 7 1 20\n0 5 15 1\n1 2\n1 10 1 1\n7 1 4\n1 11 1 1\n8 3 6\n1 12 1 2\n9 1 2\n10 2 "
    "3\n"
    "2 21 3 1\n11 1 2 5 4\n2 22 3 1\n20 2 3 6 5\n$EndElements\n"
    "$Periodic\n1\n1 11 10\n16 1 0 0 2 0 1 0 0 0 0 1 0 0 0 0 1\n2\n3 1\n6 4\n$EndPeriodic\n"
    "$NodeData\n1\n\"heat\"\n1\n0.5\n3\n2\n1\n2\n1 0.25\n5 -1\n$EndNodeData\n"
    "$ElementData\n1\n\"flow\"\n1\n0\n3\n0\n3\n2\n9 1 0 0\n20 0 1 0\n$EndElementData\n"
    "$Comments\nof the user\n$EndComments\n";

class FileContents : public FileTest {
 protected:
  /// Reads a mesh and writes it under another name. Returns what that file then says.
  MeshLabels through(const std::string& in, const std::string& out,
                     const MeshWriteOptions& options = {}) {
    const MeshFile read = read_mesh(file(in));
    write_mesh(file(out), read.mesh, {}, options);
    return labels(out);
  }
  MeshLabels labels(const std::string& name) {
    const MeshFile read = read_mesh(file(name));
    return std::visit([](const auto& mesh) { return mesh.topology().labels(); }, read.mesh);
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(file(name), std::ios::binary) << text;
  }
};

TEST_F(FileContents, MshComesOutAsItWentIn) {
  write("a.msh", all_41);
  const MeshLabels before = labels("a.msh"), after = through("a.msh", "b.msh");
  EXPECT_EQ(after, before);
  const FileContent &a = *after.content, &b = *before.content;
  EXPECT_EQ(a.version + (a.is_binary ? " binary" : ""), "4.1");
  EXPECT_EQ(a.facet_ids, b.facet_ids);
  EXPECT_EQ(a.cell_entities, b.cell_entities);
  EXPECT_EQ(a.facet_entities, b.facet_entities);
  EXPECT_EQ(a.others, b.others);
  EXPECT_EQ(a.entities, b.entities);
  EXPECT_EQ(a.node_entities, b.node_entities);
  EXPECT_EQ(a.periodic, b.periodic);
  EXPECT_EQ(a.sections, b.sections);
  EXPECT_THAT(content_of(file("b.msh")), HasSubstr("$MeshFormat\n4.1 0 8\n"));
  EXPECT_THAT(content_of(file("b.msh")), HasSubstr("$Comments\nof the user\n$EndComments\n"));
  EXPECT_THAT(losses(file("b.msh"), read_mesh(file("a.msh")).mesh), IsEmpty());
}

TEST_F(FileContents, MshKeepsItsContentInEveryVersionAndEncoding) {
  write("a.msh", all_41);
  const MeshLabels before = labels("a.msh");
  for (const auto version : {MshVersion::v2_2, MshVersion::v4_1})
    for (const bool binary : {false, true}) {
      SCOPED_TRACE(std::to_string(static_cast<int>(version)) + " " + std::to_string(binary));
      const MeshLabels after = through("a.msh", "b.msh", {version, binary});
      EXPECT_EQ(after.content->version, version == MshVersion::v2_2 ? "2.2" : "4.1");
      EXPECT_EQ(after.content->is_binary, binary);
      EXPECT_EQ(after.names, before.names);
      EXPECT_EQ(after.content->cell_entities, before.content->cell_entities);
      EXPECT_EQ(after.content->entities.at({2, 22}).groups, (std::vector<int>{3, 4}));
      EXPECT_EQ(after.content->entities.at({1, 10}).groups, (std::vector<int>{1, 2}));
      EXPECT_EQ(after.content->periodic, before.content->periodic);
      EXPECT_EQ(after.content->others, before.content->others);
      ASSERT_EQ(after.content->node_fields.size(), 1u);
      EXPECT_EQ(after.content->node_fields[0].name, "heat");
      EXPECT_EQ(after.content->node_fields[0].time, 0.5);
      EXPECT_EQ(after.content->node_fields[0].number(4), -1.0);
      EXPECT_TRUE(std::isnan(after.content->node_fields[0].number(1)));
      ASSERT_EQ(after.content->element_fields.size(), 1u);
      EXPECT_EQ(after.content->element_fields[0].number(3 + 1), 1.0);  // of element 20
    }
}

TEST_F(FileContents, EveryGroupOfAnEntityCanBeFixed) {
  write("a.msh", all_41);
  const MeshFile read = read_mesh(file("a.msh"));
  const Topology& topology = std::get<PlanarMesh>(read.mesh).topology();
  for (const std::string group : {"clamped", "grounded", "1", "2"}) {
    const auto reasons = fixed_nodes(topology, parse_fixed_nodes_rule("group=" + group));
    EXPECT_TRUE(has(reasons[0], FixedReason::marked)) << group;
    EXPECT_FALSE(has(reasons[1], FixedReason::marked)) << group;
  }
  EXPECT_TRUE(has(topology.fixed_reasons(0), FixedReason::periodic));
  EXPECT_TRUE(has(topology.fixed_reasons(1), FixedReason::interface));
}

TEST_F(FileContents, VtkKeepsTagsUnderTheirNameFieldsAndOrder) {
  write("a.vtk",
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n"
        "POINTS 6 double\n0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0\n"
        "CELLS 4 15\n2 0 1\n4 0 1 4 3\n1 4\n4 1 2 5 4\nCELL_TYPES 4\n3 9 1 9\n"
        "CELL_DATA 4\nSCALARS MaterialID int 1\nLOOKUP_TABLE default\n7 1 0 2\n"
        "FIELD more 1\nbig%20ids 1 4 vtktypeuint64\n1 2 3 18446744073709551615\n"
        "POINT_DATA 6\nVECTORS v float\n1 0 0 2 0 0 3 0 0 nan 0 0 5 0 0 6 0 0\n"
        "FIELD f 1\nn 1 6 vtktypeint32\n1 2 3 4 5 6\n");
  const MeshLabels before = labels("a.vtk");
  EXPECT_THAT(before.cell_tags, ElementsAre(1, 2));
  EXPECT_THAT(before.facet_tags, ElementsAre(7));
  for (const std::string out : {"b.vtk", "b.vtu"}) {
    SCOPED_TRACE(out);
    const MeshLabels after = through("a.vtk", out);
    EXPECT_EQ(after, before);
    EXPECT_EQ(after.content->tag_field, "MaterialID");
    EXPECT_EQ(after.content->file_order, (std::vector<std::uint32_t>{2, 0, 3, 1}));
    EXPECT_EQ(after.content->others, before.content->others);
    ASSERT_EQ(after.content->element_fields.size(), 2u);
    EXPECT_EQ(after.content->element_fields[1].name, "big ids");
    EXPECT_EQ(after.content->element_fields, before.content->element_fields);
    ASSERT_EQ(after.content->node_fields.size(), 2u);
    EXPECT_EQ(after.content->node_fields[0].type, NumberType::float32);
    EXPECT_EQ(after.content->node_fields[0].n_components, 3u);
    EXPECT_TRUE(std::isnan(after.content->node_fields[0].number(9)));
    EXPECT_EQ(after.content->node_fields[1], before.content->node_fields[1]);
  }
}

TEST_F(FileContents, UserNamesTheArrayWithTags) {
  write("a.vtk",
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n"
        "POINTS 4 double\n0 0 0 1 0 0 1 1 0 0 1 0\nCELLS 2 8\n3 0 1 2\n3 0 2 3\nCELL_TYPES 2\n5 5\n"
        "CELL_DATA 2\nSCALARS zone int 1\nLOOKUP_TABLE default\n4 6\n"
        "VECTORS wind double\n1 0 0 2 0 0\nSCALARS heat double\nLOOKUP_TABLE default\n0.5 1\n");
  EXPECT_THAT(labels("a.vtk").cell_tags, IsEmpty());
  const MeshFile read = read_mesh(file("a.vtk"), {.tag_field = "zone"});
  EXPECT_THAT(std::get<PlanarMesh>(read.mesh).topology().labels().cell_tags, ElementsAre(4, 6));
  EXPECT_THAT(input_error_of([&] { read_mesh(file("a.vtk"), {.tag_field = "region"}); }),
              HasSubstr("the file has no cell array 'region'"));
  EXPECT_THAT(input_error_of([&] { read_mesh(file("a.vtk"), {.tag_field = "wind"}); }),
              HasSubstr("has 3 components, but tags are single integers"));
  EXPECT_THAT(input_error_of([&] { read_mesh(file("a.vtk"), {.tag_field = "heat"}); }),
              HasSubstr("has the number 0.5, but tags are integers"));
  write("a.msh", all_41);
  EXPECT_THAT(input_error_of([&] { read_mesh(file("a.msh"), {.tag_field = "zone"}); }),
              HasSubstr("have no cell arrays for --tag-field"));
}

TEST_F(FileContents, MeditKeepsRequiredElementsRidgesAndReferences) {
  write(
      "a.mesh",
      "MeshVersionFormatted 2\nDimension 2\nVertices\n6\n0 0 3\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n2 1 0\n"
      "Quadrilaterals\n2\n1 2 5 4 1\n2 3 6 5 1\nEdges\n2\n1 2 7\n2 5 0\n"
      "Corners\n1\n3\nRequiredEdges\n1\n2\nRidges\n1\n1\nRequiredVertices\n1\n6\nEnd\n");
  const MeshFile read = read_mesh(file("a.mesh"));
  const Topology& topology = std::get<PlanarMesh>(read.mesh).topology();
  for (NodeIndex i = 0; i < 6; ++i)
    EXPECT_EQ(has(topology.fixed_reasons(i), FixedReason::required),
              i == 0 || i == 1 || i == 2 || i == 4)
        << i;
  const MeshLabels before = labels("a.mesh"), after = through("a.mesh", "b.mesh");
  EXPECT_EQ(after, before);
  EXPECT_EQ(*after.content, *before.content);
  EXPECT_EQ(*through("b.mesh", "c.mesh").content, *before.content);
  EXPECT_EQ(content_of(file("c.mesh")), content_of(file("b.mesh")));
}

const std::string cae_job =
    "*Heading\r\n** a comment\n*NODE, NSET=NALL\n1, 0, 0, 0\n2, 1.0, 0., 0.\n3, 1, 1, "
    "0\n4,0,1,0\n"
    "5, 0,0,1\n6, 1,0,1\n7, 1,1,1\n8, 0,1,1\n9, .5, .5, .5\n"
    "*ELEMENT, TYPE=C3D8, ELSET=EALL\n1, 1,2,3,4,5,6,7,8\n*ELEMENT, TYPE=SPRINGA, ELSET=S\n9, 1, "
    "2\n"
    "*NSET, NSET=CLAMPED\n1, 2\n*SURFACE, NAME=TOP, TYPE=ELEMENT\n1, S2\n*STEP\n*NODE PRINT\nU\n"
    "*END STEP\n";

TEST_F(FileContents, AbaqusNamesFacetsWithoutALabelAsLost) {
  write("a.msh",
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
        "$EndNodes\n$Elements\n2\n1 2 2 0 1 1 3 2\n2 4 2 0 1 1 2 3 4\n$EndElements\n");
  EXPECT_THAT(losses(file("b.inp"), read_mesh(file("a.msh")).mesh),
              ElementsAre("1 points, lines or facets without a label"));
  write("a.inp",
        "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n"
        "*ELEMENT, TYPE=S3\n1, 1, 3, 2\n*ELEMENT, TYPE=C3D4\n2, 1, 2, 3, 4\n");
  EXPECT_THAT(losses(file("b.inp"), read_mesh(file("a.inp")).mesh), IsEmpty());
}

TEST_F(FileContents, AbaqusKeepsAllTextThatIsNoCoordinate) {
  write("a.inp", cae_job);
  MeshFile read = read_mesh(file("a.inp"));
  EXPECT_THAT(read.notes, ElementsAre("1 element of type SPRINGA is left out, as it is no cell"));
  write_mesh(file("b.inp"), read.mesh);
  EXPECT_EQ(content_of(file("b.inp")), cae_job);
  std::get<VolumeMesh>(read.mesh).coordinates()[1].x() = 1.25;
  write_mesh(file("b.inp"), read.mesh);
  std::string expected = cae_job;
  expected.replace(expected.find("2, 1.0, 0., 0."), 14, "2, 1.25, 0, 0");
  EXPECT_EQ(content_of(file("b.inp")), expected);
  EXPECT_THAT(losses(file("b.inp"), read.mesh), IsEmpty());
  EXPECT_THAT(losses(file("b.vtu"), read.mesh),
              ElementsAre("*NSET CLAMPED", "*SURFACE TOP", "*STEP", "*NODE PRINT"));
}

TEST_F(FileContents, AbaqusPlacesInstances) {
  const std::string part =
      "*Node\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
      "*Element, type=C3D8R\n1, 1,2,3,4,5,6,7,8\n*Elset, elset=body\n1\n*End Part\n";
  write("a.inp", "*Part, name=A\n" + part + "*Part, name=B\n" + part +
                     "*Assembly, name=all\n*Instance, name=A-1, part=A\n*End Instance\n"
                     "*Instance, name=B-1, part=B\n0., 0., 3.\n0., 0., 3., 0., 0., 4., 90.\n"
                     "*End Instance\n*Elset, elset=upper, instance=B-1\n1\n*End Assembly\n");
  const MeshFile read = read_mesh(file("a.inp"));
  const auto& mesh = std::get<VolumeMesh>(read.mesh);
  ASSERT_EQ(mesh.n_cells(), 2u);
  // Moved by 3 along z, then turned by 90 degrees about this axis: (1, 0, 0) becomes (0, 1, 3).
  EXPECT_LT((mesh.coordinates()[9] - Point<3>(0.0, 1.0, 3.0)).norm(), 1e-14);
  EXPECT_EQ(mesh.topology().labels().names.at({3, mesh.topology().labels().cell_tags[0]}),
            "A-1.body");
  EXPECT_EQ(mesh.topology().labels().names.at({3, mesh.topology().labels().cell_tags[1]}),
            "B-1.body");
  EXPECT_THAT(read.notes, ElementsAre(HasSubstr("the 2 instances become one mesh")));
  const FileContent& content = *mesh.topology().labels().content;
  EXPECT_EQ(content.entities.at({3, content.cell_entities[1]}).groups.size(), 2u);
}

TEST_F(FileContents, AbaqusInstancesMayHaveTheirOwnNodes) {
  write("a.inp",
        "*Part, name=A\n*End Part\n*Assembly, name=all\n*Instance, name=A-1, part=A\n1., 2.\n"
        "*Node\n1,0,0\n2,1,0\n3,1,1\n*Element, type=CPS3\n1, 1,2,3\n*End Instance\n"
        "*End Assembly\n");
  const MeshFile read = read_mesh(file("a.inp"));
  EXPECT_EQ(std::get<PlanarMesh>(read.mesh).coordinates()[2], Point<2>(2, 3));
}

TEST_F(FileContents, LossesAreNamed) {
  write("a.msh", all_41);
  const MeshFile read = read_mesh(file("a.msh"));
  EXPECT_THAT(losses(file("b.vtu"), read.mesh),
              UnorderedElementsAre(HasSubstr("(grounded, source)"), "periodic partners",
                                   "the section $Comments"));
  EXPECT_THAT(
      losses(file("b.mesh"), read.mesh),  // Medit, which loses less than the other format
      ::testing::IsSupersetOf({"names of groups", "the fields heat, flow", "periodic partners"}));
  const auto& formats = mesh_formats();
  const auto polygonal = std::find_if(formats.begin(), formats.end(),
                                      [](const auto& f) { return f.name == "polygonal"; });
  EXPECT_THAT(losses(*polygonal, read.mesh),
              ::testing::IsSupersetOf({"the tags of cells", "labelled facets"}));
}

/// One square in two groups, and one in a single group; data of each row.
std::string repeated_22(const std::string& value_of_second_row) {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n"
         "5 1 1 0\n6 2 1 0\n$EndNodes\n$Elements\n3\n1 3 2 7 1 1 2 5 4\n2 3 2 8 1 1 2 5 4\n"
         "3 3 2 7 1 2 3 6 5\n$EndElements\n$ElementData\n1\n\"k\"\n1\n0\n3\n0\n1\n3\n1 5\n2 " +
         value_of_second_row + "\n3 6\n$EndElementData\n";
}

TEST_F(FileContents, RepeatedElementsKeepTheirNumbersAndData) {
  write("a.msh", repeated_22("9"));
  through("a.msh", "b.msh");
  const std::string written = content_of(file("b.msh"));
  for (const std::string row : {"\n1 3 2 7 1 1 2 5 4\n", "\n2 3 2 8 1 1 2 5 4\n",
                                "\n3 3 2 7 2 2 3 6 5\n", "\n1 5\n", "\n2 9\n", "\n3 6\n"})
    EXPECT_THAT(written, HasSubstr(row));
}

TEST_F(FileContents, DataThatDifferBetweenGroupsAreNamed) {
  write("a.msh", repeated_22("9"));
  write("same.msh", repeated_22("5"));
  const AnyMesh mesh = read_mesh(file("a.msh")).mesh, same = read_mesh(file("same.msh")).mesh;
  const std::string what = "the data of 1 element that differ between their groups";
  EXPECT_THAT(losses(file("b.msh"), mesh), IsEmpty());
  EXPECT_THAT(losses(file("b.msh"), mesh, {MshVersion::v4_1, {}}), ElementsAre(what));
  EXPECT_THAT(losses(file("b.msh"), same, {MshVersion::v4_1, {}}), IsEmpty());
  EXPECT_THAT(losses(file("b.vtu"), mesh), ::testing::Contains(what));
}

TEST_F(FileContents, TextThatOnlyTheSameVersionHoldsIsNamed) {
  write("a.msh", all_41);
  const AnyMesh mesh = read_mesh(file("a.msh")).mesh;
  EXPECT_THAT(losses(file("b.msh"), mesh, {MshVersion::v4_1, false}), IsEmpty());
  for (const MeshWriteOptions& options :
       {MeshWriteOptions{MshVersion::v2_2, false}, MeshWriteOptions{{}, true}})
    EXPECT_THAT(losses(file("b.msh"), mesh, options), ElementsAre("the section $Comments"));
}

TEST_F(FileContents, GroupsOfPointsWithoutCellsAreNamed) {
  std::string text = repeated_22("9");
  text.replace(text.find("$Nodes\n6\n"), 9, "$Nodes\n7\n8 5 5 5\n");
  text.replace(text.find("$Elements\n3\n"), 12, "$Elements\n4\n9 15 2 4 4 8\n");
  write("a.msh", text);
  EXPECT_THAT(read_mesh(file("a.msh")).notes,
              ElementsAre("1 node that no cell uses is left out, with its point of the group 4"));
}

/// Two triangles and an edge without cells, an array for each role.
const std::string roles_vtk =
    "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n"
    "POINTS 4 double\n0 0 0 1 0 0 1 1 0 0 1 0\n"
    "CELLS 3 11\n3 0 1 2\n3 0 2 3\n2 1 3\nCELL_TYPES 3\n5 5 3\n"
    "CELL_DATA 3\nSCALARS material int\nLOOKUP_TABLE default\n3\n4\n0\n"
    "PEDIGREE_IDS number int\n7\n8\n9\n"
    "POINT_DATA 4\nSCALARS two float 2\nLOOKUP_TABLE default\n1 2\n3 4\n5 6\n7 8\n"
    "VECTORS v double\n1 0 0\n2 0 0\n3 0 0\n4 0 0\n"
    "NORMALS n float\n0 0 1\n0 0 1\n0 0 1\n0 0 1\n"
    "TEXTURE_COORDINATES texture 2 float\n0 0\n1 0\n1 1\n0 1\n"
    "TENSORS stress float\n1 0 0 0 1 0 0 0 1\n1 0 0 0 1 0 0 0 1\n1 0 0 0 1 0 0 0 1\n"
    "1 0 0 0 1 0 0 0 1\nGLOBAL_IDS id vtkIdType\n4\n3\n2\n1\n"
    "FIELD FieldData 1\nplain 1 4 int\n1\n2\n3\n4\n";

TEST_F(FileContents, ArraysOfVtkKeepTheirRoles) {
  write("a.vtk", roles_vtk);
  const MeshLabels before = labels("a.vtk");
  EXPECT_THAT(before.content->element_roles,
              UnorderedElementsAre(::testing::Pair("Scalars", "material"),
                                   ::testing::Pair("PedigreeIds", "number")));
  EXPECT_EQ(before.content->node_roles.size(), 6u);
  for (const auto& [out, is_binary] : std::vector<std::pair<std::string, bool>>{
           {"b.vtk", false}, {"b.vtk", true}, {"b.vtu", false}, {"b.vtu", true}}) {
    SCOPED_TRACE(out + (is_binary ? " binary" : " text"));
    const MeshLabels after = through("a.vtk", out, {.binary = is_binary});
    EXPECT_EQ(after.content->node_roles, before.content->node_roles);
    EXPECT_EQ(after.content->element_roles, before.content->element_roles);
    EXPECT_EQ(after.content->node_fields.size(), 7u);
    for (const MeshField& field : before.content->node_fields) {
      if (field.name == "id") continue;  // gets VTK's type of indices
      EXPECT_THAT(after.content->node_fields, ::testing::Contains(field));
    }
  }
  through("a.vtk", "text.vtk", {.binary = false});
  const std::string written = content_of(file("text.vtk"));
  for (const char* const keyword : {"CELL_DATA", "POINT_DATA"}) {
    const auto section = [&](const std::string& text) {
      const std::string begin = text.substr(text.find(keyword));
      return begin.substr(0, begin.find("FIELD"));
    };
    const std::string of_text = section(written), of_file = section(roles_vtk);
    EXPECT_THAT(of_text, HasSubstr(of_file.substr(0, of_file.find("TENSORS"))));
  }
}

/// VTK's reader of text stops at "nan".
TEST_F(FileContents, ElementsWithoutACellHaveTheValueZero) {
  write("a.vtk", roles_vtk);
  const MeshFile read = read_mesh(file("a.vtk"));
  for (const auto& [out, is_binary] : std::vector<std::pair<std::string, bool>>{
           {"b.vtk", false}, {"b.vtk", true}, {"b.vtu", true}}) {
    SCOPED_TRACE(out + (is_binary ? " binary" : " text"));
    write_mesh(file(out), read.mesh, {.cell = {{"q", {0.5, 0.25}}}, .point = {}},
               {.binary = is_binary});
    const MeshLabels after = labels(out);
    const auto& fields = after.content->element_fields;
    const auto q = std::find_if(fields.begin(), fields.end(),
                                [](const MeshField& field) { return field.name == "q"; });
    ASSERT_NE(q, fields.end());
    EXPECT_EQ(std::get<std::vector<double>>(q->values), (std::vector{0.5, 0.25, 0.0}));
  }
}

TEST_F(FileContents, PolygonalDataPixelsAndVoxelsGetANote) {
  const std::string version = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET ";
  write("a.vtk", version + "POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n");
  EXPECT_THAT(read_mesh(file("a.vtk")).notes,
              ElementsAre("the polygonal data become an unstructured grid"));
  write("b.vtk", version +
                     "UNSTRUCTURED_GRID\nPOINTS 8 float\n0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 "
                     "1 1 1\nCELLS 2 14\n8 0 1 2 3 4 5 6 7 4 0 1 2 3\nCELL_TYPES 2\n11 8\n");
  EXPECT_THAT(read_mesh(file("b.vtk")).notes,
              ElementsAre("pixels become quadrilaterals", "voxels become hexahedra"));
}

TEST_F(FileContents, PlanesComeBackInTheirPlaneAndUnmovedNodesBitByBit) {
  const std::string points[] = {"0 0 5 1 0 5 1 1 5 0 1 5",           // z = 5
                                "0 3 0 1 3 0 1 3 1 0 3 1",           // y = 3
                                "0 0 1e-13 1 0 0 1 1 -1e-13 0 1 0",  // noise
                                "0 0 0 1 0 0 1 0.6 0.8 0 0.6 0.8"};  // tilted
  for (const std::string& text : points) {
    SCOPED_TRACE(text);
    write("a.vtk",
          "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n" +
              text + "\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n9\n");
    MeshFile read = read_mesh(file("a.vtk"));
    auto& mesh = std::get<PlanarMesh>(read.mesh);
    EXPECT_NEAR((mesh.coordinates()[2] - mesh.coordinates()[0]).norm(), std::sqrt(2.0), 1e-12);
    const MeshView view(mesh);
    std::istringstream expected(text);
    for (NodeIndex i = 0; i < 4; ++i)
      for (int d = 0; d < 3; ++d) {
        double x = 0.0;
        expected >> x;
        EXPECT_EQ(view.point(i)[d], x);
      }
    const Point<3> corner = view.point(1);
    mesh.coordinates()[1] += Point<2>(0.25, 0.0);
    EXPECT_LT((view.point(1) - corner - Point<3>(0.25, 0.0, 0.0)).norm(), 1e-12);
  }
}

TEST_F(FileContents, SlightlyCurvedSurfacesAreNoPlanes) {
  write("a.vtk",
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n"
        "0 0 1e-8 1 0 0 1 1 0 0 1 0\nCELLS 2 8\n3 0 1 2\n3 0 2 3\nCELL_TYPES 2\n5 5\n");
  EXPECT_TRUE(std::holds_alternative<SurfaceMesh>(read_mesh(file("a.vtk")).mesh));
}

}  // namespace
}  // namespace smoothfem
