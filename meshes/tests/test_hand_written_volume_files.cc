// SPDX-License-Identifier: GPL-3.0-or-later
// Hand-written volume files: the features that each format documents, and refused files.
#include <functional>
#include <map>

#include "meshes/tests/mesh_tests.h"
#include "smoothing/geometry/cell_size.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {
namespace {

// A unit cube, a pyramid of volume 1/3 on it, a prism of volume 1/2 at its side and a tetrahedron
// of volume 5/24 at the pyramid. Hand-written in the node order that each format documents.

const std::string point_lines[] = {"0 0 0", "1 0 0", "1 1 0",   "0 1 0",  "0 0 1",  "1 0 1",
                                   "1 1 1", "0 1 1", ".5 .5 2", "2 .5 0", "2 .5 1", ".5 -1 1.5"};

/// The nodes on separate lines; before: text before the coordinates.
std::string node_lines(const std::function<std::string(int)>& before, const std::string& after) {
  std::string text;
  int n = 0;
  for (const std::string& point : point_lines) text += before(++n) + point + after + "\n";
  return text;
}
std::string nothing(int) {
  return {};
}

const std::string hand_written_gmsh =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n12\n" +
    node_lines([](int n) { return std::to_string(n) + " "; }, "") +
    "$EndNodes\n$Elements\n4\n1 5 2 0 1 1 2 3 4 5 6 7 8\n2 7 2 0 1 5 6 7 8 9\n"
    "3 6 2 0 1 2 10 3 6 11 7\n4 4 2 0 1 5 6 9 12\n$EndElements\n";

std::string hand_written_vtk(const std::string& wedge) {
  return "# vtk DataFile Version 2.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 12 double\n" +
         node_lines(nothing, "") + "CELLS 4 27\n8 0 1 2 3 4 5 6 7\n5 4 5 6 7 8\n6 " + wedge +
         "\n4 4 5 8 11\nCELL_TYPES 4\n12\n14\n13\n10\n";
}
const std::string vtk_wedge_row = "1 2 9 5 6 10", gmsh_prism_row = "1 9 2 5 10 6";

const std::string hand_written_medit =
    "MeshVersionFormatted 2\n# a comment\nDimension\n3\n\nVertices\n12\n" +
    node_lines(nothing, " 0") +
    "Corners 1\n1\nHexahedra 1 1 2 3 4 5 6 7 8 0\nPyramids\n1\n5 6 7 8 9\n0 # of the last one\n"
    "Prisms\n1\n2 10 3 6 11 7 0\nTetrahedra\n1\n5 6 9 12 0\nNormals\n1\n0 0 1\nEnd\n";

std::string hand_written_abaqus() {
  std::string nodes = node_lines([](int n) { return std::to_string(n) + " "; }, "");
  std::replace(nodes.begin(), nodes.end(), ' ', ',');
  return "*Heading\nwritten manually, 2 lines\n** a comment\n*Node\n" + nodes +
         "*Element, type=C3D8R,\nelset=Cube\n1, 1, 2, 3, 4, 5,\n6, 7, 8\n"
         "*ELEMENT, TYPE=C3D5\n2, 5, 6, 7, 8, 9\n*element, type=C3D6\n3, 2, 10, 3, 6, 11, 7\n"
         "*Element, Type=DC3D4\n4, 5, 6, 9, 12\n";
}

struct HandWritten {
  std::string name, extension, content;
  friend void PrintTo(const HandWritten& parameter, std::ostream* out) { *out << parameter.name; }
};

class HandWrittenFiles : public FileTest, public ::testing::WithParamInterface<HandWritten> {};

TEST_P(HandWrittenFiles, HaveTheirVolumes) {
  const VolumeMesh mesh = read_volume(file_with("a" + GetParam().extension, GetParam().content));
  EXPECT_NO_THROW(require_valid(mesh));
  std::map<ElementType, double> volumes;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    volumes[mesh.topology().cell_type(c)] = signed_cell_size(mesh, c);
  ASSERT_EQ(volumes.size(), 4u);
  EXPECT_NEAR(volumes[ElementType::hexahedron], 1.0, 1e-15);
  EXPECT_NEAR(volumes[ElementType::pyramid], 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(volumes[ElementType::prism], 0.5, 1e-15);
  EXPECT_NEAR(volumes[ElementType::tetrahedron], 5.0 / 24.0, 1e-15);
}

INSTANTIATE_TEST_SUITE_P(Volumes, HandWrittenFiles,
                         ::testing::Values(HandWritten{"gmsh", ".msh", hand_written_gmsh},
                                           HandWritten{"vtk", ".vtk",
                                                       hand_written_vtk(vtk_wedge_row)},
                                           HandWritten{"vtk_in_the_order_of_gmsh", ".vtk",
                                                       hand_written_vtk(gmsh_prism_row)},
                                           HandWritten{"medit", ".mesh", hand_written_medit},
                                           HandWritten{"abaqus", ".inp", hand_written_abaqus()}),
                         [](const auto& info) { return info.param.name; });

using VolumeFiles = FileTest;

TEST_F(VolumeFiles, WedgesAreWrittenInTheOrderOfVtk) {
  const auto path = file_with("a.msh", hand_written_gmsh);
  write_mesh(file("a.vtu"), read_volume(path));
  const VolumeMesh again = read_volume(file("a.vtu"));
  EXPECT_EQ(again.topology().cells(), read_volume(path).topology().cells());
  // One wedge against two: the majority decides, and the other wedge keeps its order in the file.
  const std::string two_against_one =
      "# vtk DataFile Version 2.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 12 double\n"
      "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 1\n0 1 1\n0 0 2\n1 0 2\n0 1 2\n0 0 3\n1 0 3\n0 1 3\n"
      "CELLS 3 21\n6 0 2 1 3 5 4\n6 3 5 4 6 8 7\n6 6 7 8 9 10 11\nCELL_TYPES 3\n13\n13\n13\n";
  const VolumeMesh mesh = read_volume(file_with("b.vtk", two_against_one), {.turns_over = false});
  EXPECT_GT(signed_cell_size(mesh, 0), 0.0);
  EXPECT_GT(signed_cell_size(mesh, 1), 0.0);
  EXPECT_LT(signed_cell_size(mesh, 2), 0.0);
}

TEST_F(VolumeFiles, VoxelsAreHexahedra) {
  const VolumeMesh mesh = read_volume(file_with(
      "a.vtk",
      "# vtk DataFile Version 2.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\nCELLS 1 9\n8 0 1 2 3 4 5 6 7\n"
      "CELL_TYPES 1\n11\n"));
  EXPECT_EQ(mesh_quality(mesh).q_min, 1.0);
}

TEST_F(VolumeFiles, KeepsInvertedCellsAndNamesThemByNumberAndLine) {
  const auto path = file_with(
      "a.inp",
      "*NODE\n10,0,0,0\n20,1,0,0\n30,0,1,0\n40,0,0,1\n*ELEMENT,TYPE=C3D4\n7,10,30,20,40\n");
  const MeshFile read = read_mesh(path, {.turns_over = false});
  const auto& mesh = std::get<VolumeMesh>(read.mesh);
  EXPECT_EQ(mesh.topology().labels().node_ids, (std::vector<std::size_t>{10, 20, 30, 40}));
  EXPECT_THAT(input_error_of([&] { require_valid(mesh, path.string(), read.cell_lines); }),
              ::testing::AllOf(::testing::StartsWith(path.string() + ":7: "),
                               ::testing::HasSubstr("cell 7")));
}

TEST_F(VolumeFiles, MeditNeedsNoEndAfterCompleteSections) {
  std::string content = hand_written_medit;
  content.erase(content.find("End"));
  EXPECT_EQ(read_volume(file_with("a.mesh", content)).n_cells(), 4u);
}

TEST_F(VolumeFiles, MeditSectionsMayEachHaveAnEnd) {
  std::string content = hand_written_medit;
  for (const std::string section : {"Pyramids", "Tetrahedra"})
    content.insert(content.find(section), "\nEnd\n\n");
  EXPECT_EQ(read_volume(file_with("a.mesh", content)).n_cells(), 4u);
  EXPECT_EQ(read_volume(file_with("a.mesh", content + "whatever\n1 2\n")).n_cells(), 4u);
}

TEST_F(VolumeFiles, AbaqusSetsAreNames) {
  const MeshFile read = read_mesh(file_with(
      "a.inp",
      "*PART, NAME=one\n*NODE\n1,0,0,0\n2,1,0\n3,0,1,0\n4,0,0,1\n5,1,1,1.5D0\n"
      "*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n2,2,5,3,4\n*ELEMENT, TYPE=S3, ELSET=\"the wall\"\n9,1,3,2\n"
      "*ELSET, ELSET=Steel, GENERATE\n2,8,2\n*ELSET,ELSET=all\n1,2,steel\n*END PART\n"
      "*ASSEMBLY, NAME=a\n*INSTANCE, NAME=one-1, PART=one\n*END INSTANCE\n"
      "*NODE\n1,9,9,9\n*NSET, NSET=reference\n1\n*END ASSEMBLY\n"));
  const MeshLabels& labels = std::get<VolumeMesh>(read.mesh).topology().labels();
  EXPECT_EQ(labels.facets.size(), 1u);
  EXPECT_EQ(labels.names.at({2, labels.facet_tags[0]}), "the wall");
  EXPECT_EQ(labels.names.at({3, labels.cell_tags[0]}), "all");
  EXPECT_EQ(labels.names.at({3, labels.cell_tags[1]}), "Steel");
}

struct BadVolume {
  std::string name, extension, content, message;
  friend void PrintTo(const BadVolume& parameter, std::ostream* out) { *out << parameter.name; }
};

class BadVolumeFile : public FileTest, public ::testing::WithParamInterface<BadVolume> {};

TEST_P(BadVolumeFile, IsRefusedWithPositionAndReason) {
  const auto path = file_with("bad" + GetParam().extension, GetParam().content);
  const std::string message = input_error_of([&] { read_mesh(path); });
  EXPECT_THAT(message, ::testing::StartsWith(path.string() + ":"));
  EXPECT_THAT(message, ::testing::HasSubstr(GetParam().message));
}

const std::string medit_head =
    "MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";
const std::string abaqus_head = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n";

INSTANTIATE_TEST_SUITE_P(
    Volumes, BadVolumeFile,
    ::testing::Values(
        BadVolume{"medit_no_end_in_a_number", ".mesh", medit_head + "Tetrahedra 1\n1 2 3 4 0",
                  ":9: the file ends before the last word, 'End'"},
        BadVolume{"medit_no_end_in_an_element", ".mesh", medit_head + "Tetrahedra 1\n1 2 3\n",
                  ":9: the file ends before the node"},
        BadVolume{"medit_no_end_in_other_entries", ".mesh",
                  medit_head + "Tetrahedra 1\n1 2 3 4 0\nNormals 2\n0 0 1\n",
                  ":11: the file ends before the last word, 'End'"},
        BadVolume{"medit_count", ".mesh", medit_head + "Tetrahedra 99999\n1 2 3 4 0\nEnd\n",
                  ":8: the section Tetrahedra announces 99999"},
        BadVolume{"medit_more", ".mesh", medit_head + "Tetrahedra 1\n1 2 3 4 0\n5 6\nEnd\n",
                  ":10: expected the name of a section, but found '5'"},
        BadVolume{"medit_node", ".mesh", medit_head + "Tetrahedra 1\n1 2 3 5 0\nEnd\n",
                  ":9: the node is 5, but must be below 5"},
        BadVolume{"medit_zero", ".mesh", medit_head + "Tetrahedra 1\n0 1 2 3 0\nEnd\n",
                  ":9: the node is 0, but nodes are counted from 1"},
        BadVolume{"medit_number", ".mesh",
                  "MeshVersionFormatted 2\nDimension 3\nVertices 1\n0 0 x 0\n",
                  ":4: a coordinate is 'x', which is not a number"},
        BadVolume{"medit_curved", ".mesh", medit_head + "HexahedraQ2 1\n",
                  "only EdgesP2, TrianglesP2, QuadrilateralsQ2 and TetrahedraP2"},
        BadVolume{"medit_twice", ".mesh", medit_head + "Tetrahedra 1\n1 2 3 3 0\nEnd\n",
                  ":9: cell 0 names node 3 more than once; give the cell different nodes"},
        BadVolume{"abaqus_type", ".inp", abaqus_head + "*ELEMENT, TYPE=C3D27\n1,1,2,3,4\n",
                  ":6: the element type 'C3D27' cannot be read"},
        BadVolume{"abaqus_node", ".inp", abaqus_head + "*ELEMENT, TYPE=C3D4\n1,1,2,3,5\n",
                  ":7: the element names node 5, which the file does not have"},
        BadVolume{"abaqus_few", ".inp", abaqus_head + "*ELEMENT, TYPE=C3D4\n1,1,2,3\n*STEP\n",
                  "the element has 3 nodes, but its type C3D4 has 4"},
        BadVolume{"abaqus_many", ".inp", abaqus_head + "*ELEMENT, TYPE=C3D4\n1,1,2,3,4,4\n",
                  ":7: the element has more nodes than the 4"},
        BadVolume{"abaqus_twice", ".inp",
                  abaqus_head + "*ELEMENT, TYPE=C3D4\n1,1,2,3,4\n1,1,2,3,4\n",
                  ":8: the element 1 is defined twice"},
        BadVolume{"abaqus_empty_field", ".inp", "*NODE\n,0,0\n", ":2: the node has no label"},
        BadVolume{"abaqus_moved", ".inp",
                  abaqus_head + "*INSTANCE, NAME=a, PART=b\n0,0,0,0\n*END INSTANCE\n",
                  ":8: the place of the instance is not a line with"},
        BadVolume{"abaqus_include", ".inp", "*INCLUDE, INPUT=mesh.inp\n",
                  ":1: the included file 'mesh.inp' does not exist"},
        BadVolume{"abaqus_range", ".inp", abaqus_head + "*ELSET, ELSET=a, GENERATE\n5,1\n",
                  ":7: the labels from 5 to 1 in steps of 1 are not a range"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace smoothfem
