// SPDX-License-Identifier: GPL-3.0-or-later
/// Files under the name of another format, files in several pieces, and both encodings.
#include <cmath>
#include <cstdlib>

#include "meshes/io/losses.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/tests/mesh_tests.h"

namespace smoothfem {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// One square, as each format says it.
const std::string square_abaqus =
                      "** a comment\n*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n"
                      "*ELEMENT, TYPE=CPS4, ELSET=A\n1,1,2,3,4\n",
                  square_msh_1 =
                      "$NOD\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$ENDNOD\n"
                      "$ELM\n2\n1 1 7 1 2 1 2\n2 3 5 1 4 1 2 3 4\n$ENDELM\n",
                  square_medit =
                      "MeshVersionFormatted 2\nDimension 2\nVertices\n4\n0 0 0\n1 0 0\n"
                      "1 1 0\n0 1 0\nQuadrilaterals\n1\n1 2 3 4 5\nEnd\n",
                  square_ucd =
                      "# by AVS\n4 2 1 0 0\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
                      "1 5 quad 1 2 3 4\n2 7 line 1 2\n1 1\nheat, K\n"
                      "1 0.5\n2 1\n3 1\n4 2\n",
                  square_vtk =
                      "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                      "POINTS 4 double\n0 0 0 1 0 0 1 1 0 0 1 0\nCELLS 1 5\n4 0 1 2 3\n"
                      "CELL_TYPES 1\n9\n";

class RecognizedFormats : public FileTest {
 protected:
  const Topology& topology(const MeshFile& read) {
    return std::get<PlanarMesh>(read.mesh).topology();
  }
};

TEST_F(RecognizedFormats, ContentCountsAndNotTheName) {
  write_mesh(file("a.vtu"), read_mesh(file_with("a.vtk", square_vtk)).mesh);
  const std::string square_vtu = content_of(file("a.vtu"));
  const std::vector<std::pair<std::string, std::string>> contents{
      {"abaqus", square_abaqus}, {"gmsh", square_msh_1}, {"medit", square_medit},
      {"ucd", square_ucd},       {"vtk", square_vtk},    {"vtu", square_vtu}};
  for (const std::string extension : {".msh", ".vtk", ".vtu", ".mesh", ".inp", ".dat"})
    for (const auto& [name, content] : contents) {
      SCOPED_TRACE(name + " as " + extension);
      const MeshFile read = read_mesh(file_with("b" + extension, content));
      EXPECT_EQ(topology(read).n_cells(), 1u);
      EXPECT_EQ(topology(read).labels().content->format, name);
      const bool is_its_name = "." + name == extension || (name == "gmsh" && extension == ".msh") ||
                               (name == "medit" && extension == ".mesh") ||
                               ((name == "abaqus" || name == "ucd") && extension == ".inp");
      const std::string note = read.notes.empty() ? "" : read.notes.front();
      EXPECT_EQ(note.find("it is read as " + name + " (") == note.npos, is_its_name) << note;
    }
}

TEST_F(RecognizedFormats, BinaryUcdIsRefusedByItsName) {
  EXPECT_THAT(input_error_of([&] { read_mesh(file_with("a.inp", "\x07 \x01 binary")); }),
              HasSubstr("binary UCD of AVS, which is not read; save it as text"));
}

TEST_F(RecognizedFormats, FirstVersionOfGmshIsWrittenAsTwoPointTwo) {
  const MeshFile read = read_mesh(file_with("a.msh", square_msh_1));
  EXPECT_THAT(read.notes, ElementsAre(HasSubstr("version 1 of Gmsh's format")));
  EXPECT_THAT(topology(read).labels().cell_tags, ElementsAre(5));
  EXPECT_THAT(topology(read).labels().facet_tags, ElementsAre(7));
  write_mesh(file("b.msh"), read.mesh);
  EXPECT_THAT(content_of(file("b.msh")), ::testing::StartsWith("$MeshFormat\n2.2 0 8\n"));
  EXPECT_THAT(
      input_error_of([&] {
        read_mesh(file_with("c.msh", "$NOD\n1\n1 0 0 0\n$ENDNOD\n$ELM\n1\n1 2 0 0 4 1 1 1 1\n"));
      }),
      HasSubstr("c.msh:7: element 1 has another number of nodes than its type"));
}

TEST_F(RecognizedFormats, UcdHasTagsFieldsAndVolumeCells) {
  const MeshFile read = read_mesh(file_with("a.inp", square_ucd));
  EXPECT_THAT(read.notes, ElementsAre(HasSubstr("UCD of AVS, which is only read")));
  EXPECT_THAT(topology(read).labels().cell_tags, ElementsAre(5));
  EXPECT_THAT(topology(read).labels().facet_tags, ElementsAre(7));
  const FileContent& content = *topology(read).labels().content;
  ASSERT_EQ(content.node_fields.size(), 1u);
  EXPECT_EQ(content.node_fields[0].name, "heat");
  EXPECT_EQ(content.node_fields[0].number(3), 2.0);
  // The top comes first; no cell has to be turned over.
  const std::string cube =
      "1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n";
  for (const std::string cell :
       {"hex 5 6 7 8 1 2 3 4", "prism 5 6 8 1 2 4", "pyr 5 1 2 3 4", "tet 1 2 5 4"}) {
    SCOPED_TRACE(cell);
    const MeshFile volume =
        read_mesh(file_with("b.inp", "8 1 0 0 0\n" + cube + "1 0 " + cell + "\n"));
    EXPECT_THAT(volume.notes, ::testing::Not(::testing::Contains(HasSubstr("turned"))));
  }
  EXPECT_THAT(
      input_error_of([&] { read_mesh(file_with("c.inp", "1 1 0 0 0\n1 0 0 0\n1 0 tri9\n")); }),
      HasSubstr("c.inp:3: the cell type 'tri9' is not one of"));
}

TEST_F(RecognizedFormats, FormatsThatAreOnlyReadAreNotWritten) {
  const MeshFile read = read_mesh(file_with("a.vtk", square_vtk));
  EXPECT_THAT(input_error_of([&] { write_mesh(file("b.pvtu"), read.mesh); }),
              HasSubstr("files .pvtu are only read; use .vtu"));
  EXPECT_THAT(input_error_of([&] { require_mesh_path(file("b.pvtu")); }), HasSubstr("only read"));
  EXPECT_EQ(extension_to_write("a.pvtu"), ".vtu");
  EXPECT_EQ(extension_to_write("a.MSH"), ".MSH");
}

TEST_F(RecognizedFormats, BothEncodingsOfVtkKeepEveryBit) {
  const auto in = file_with(
      "a.vtk", square_vtk +
                   "CELL_DATA 1\nFIELD f 1\nbig%20id 1 1 vtktypeuint64\n"
                   "18446744073709551615\nPOINT_DATA 4\nVECTORS v float\n"
                   "0.1 0 0 2 0 0 nan 0 0 5 0 0\nFIELD g 1\nb 1 4 unsigned_char\n0 1 255 3\n");
  MeshFile read = read_mesh(in);
  auto& mesh = std::get<PlanarMesh>(read.mesh);
  mesh.coordinates()[2] = {1.0 + 0x1p-52, 1.0 / 3.0};
  const FileContent& before = *mesh.topology().labels().content;
  EXPECT_FALSE(before.is_binary);
  for (const std::string to : {"vtk", "vtk-text", "vtk-binary", "vtu", "vtu-text", "vtu-binary"}) {
    SCOPED_TRACE(to);
    const WriteTarget target = parse_write_target(to);
    const auto path = file("b" + target.extension);
    write_mesh(path, mesh, {}, target.options);
    const MeshFile again = read_mesh(path);
    EXPECT_EQ(std::get<PlanarMesh>(again.mesh).copied_coordinates(), mesh.copied_coordinates());
    const FileContent& after = *topology(again).labels().content;
    EXPECT_EQ(after.is_binary, to.ends_with("-binary") || to == "vtu");
    ASSERT_EQ(after.element_fields, before.element_fields);
    ASSERT_EQ(after.node_fields.size(), 2u);
    EXPECT_EQ(static_cast<float>(after.node_fields[0].number(0)), 0.1f);
    EXPECT_TRUE(std::isnan(after.node_fields[0].number(6)));
    EXPECT_EQ(after.node_fields[1], before.node_fields[1]);
  }
  EXPECT_THAT(input_error_of([] { parse_write_target("inp-text"); }),
              HasSubstr("files .inp have one encoding only"));
}

class Pieces : public RecognizedFormats {
 protected:
  /// The unit square from x, with a number of its cell and, if it is a ghost, its mark.
  std::string piece(int x, int number, bool is_ghost_too = false, const std::string& ids = "") {
    const std::string a = std::to_string(x), b = std::to_string(x + 1), c = std::to_string(x + 2);
    const auto array = [](const std::string& name, const std::string& type, int n,
                          const std::string& values) {
      return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
             std::to_string(n) + "\" format=\"ascii\">" + values + "</DataArray>\n";
    };
    const std::string more = is_ghost_too ? " " : "";
    return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"" +
           std::string(is_ghost_too ? "6" : "4") + "\" NumberOfCells=\"" +
           (is_ghost_too ? "2" : "1") + "\">\n<Points>" +
           array("p", "Float64", 3,
                 a + " 0 0 " + b + " 0 0 " + b + " 1 0 " + a + " 1 0" +
                     (is_ghost_too ? " " + c + " 0 0 " + c + " 1 0" : "")) +
           "</Points><Cells>" +
           array("connectivity", "Int32", 1, is_ghost_too ? "0 1 2 3 1 4 5 2" : "0 1 2 3") +
           array("offsets", "Int32", 1, is_ghost_too ? "4 8" : "4") +
           array("types", "UInt8", 1, is_ghost_too ? "9 9" : "9") + "</Cells><CellData>" +
           array("n", "Int32", 1, std::to_string(number) + (is_ghost_too ? " 99" : "")) +
           array("vtkGhostType", "UInt8", 1, is_ghost_too ? "0 1" : "0") + "</CellData>" +
           (ids.empty() ? ""
                        : "<PointData GlobalIds=\"ids\">" + array("ids", "Int64", 1, ids) +
                              "</PointData>") +
           "</Piece></UnstructuredGrid></VTKFile>\n";
  }
  std::string list(const std::vector<std::string>& names) {
    std::string text = "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid>\n";
    for (const std::string& name : names) text += "<Piece Source=\"" + name + "\"/>\n";
    return text + "</PUnstructuredGrid></VTKFile>\n";
  }
};

/// Of the nodes that the numbers join, one has another place: it stays apart.
TEST_F(Pieces, AreJoinedByTheNumbersOfTheirNodes) {
  file_with("a_0.vtu", piece(0, 10, false, "0 1 4 3"));
  file_with("a_1.vtu", piece(1, 11, false, "1 2 5 4"));
  file_with("a_2.vtu", piece(2, 12, false, "2 9 8 0"));
  const MeshFile read = read_mesh(file_with("a.pvtu", list({"a_0.vtu", "a_1.vtu", "a_2.vtu"})));
  EXPECT_EQ(topology(read).n_nodes(), 9u);
  EXPECT_EQ(topology(read).boundary_facets().size(), 10u);
  EXPECT_THAT(read.notes, ::testing::Contains(HasSubstr("3 nodes are those of earlier pieces")));
  EXPECT_THAT(std::get<PlanarMesh>(read.mesh).coordinates()[4], Point<2>(2.0, 0.0));
}

TEST_F(Pieces, ArePutTogetherWithoutGhosts) {
  file_with("a_0.vtu", piece(0, 10, true));
  file_with("a_1.vtu", piece(1, 11));
  const MeshFile read = read_mesh(file_with("a.pvtu", list({"a_0.vtu", "a_1.vtu"})));
  EXPECT_EQ(topology(read).n_cells(), 2u);
  EXPECT_EQ(topology(read).n_nodes(), 8u);
  EXPECT_THAT(read.notes, ::testing::Contains(HasSubstr("1 ghost cells")));
  EXPECT_THAT(read.notes, ::testing::Contains(HasSubstr("2 pieces, which are read as one mesh")));
  const FileContent& content = *topology(read).labels().content;
  EXPECT_EQ(content.format, "vtu");
  ASSERT_EQ(content.element_fields.size(), 1u);
  EXPECT_EQ(content.element_fields[0].number(0), 10.0);
  EXPECT_EQ(content.element_fields[0].number(1), 11.0);
}

TEST_F(Pieces, ThatDoNotMarkGhostsHaveNone) {
  std::string second = piece(1, 11);
  const std::size_t at = second.find("vtkGhostType");
  ASSERT_NE(at, std::string::npos);
  file_with("a_0.vtu", piece(0, 10, true));
  file_with("a_1.vtu", second.replace(at, 12, "another"));
  for (const auto& order :
       {std::vector<std::string>{"a_0.vtu", "a_1.vtu"}, {"a_1.vtu", "a_0.vtu"}}) {
    const MeshFile read = read_mesh(file_with("a.pvtu", list(order)));
    EXPECT_EQ(topology(read).n_cells(), 2u);
    EXPECT_THAT(read.notes, ::testing::Contains(HasSubstr("1 ghost cells")));
  }
}

TEST_F(Pieces, AreRefusedIfTheyAreElsewhereMissingOrListedTwice) {
  std::filesystem::create_directory(file("job"));
  file_with("a.vtu", piece(0, 10));
  file_with("job/a.vtu", piece(0, 10));
  const auto error = [&](const std::vector<std::string>& names) {
    const auto path = file_with("job/a.pvtu", list(names));
    return input_error_of([&] { read_mesh(path); });
  };
  EXPECT_THAT(error({"../a.vtu"}),
              HasSubstr("a.pvtu:2: the piece '../a.vtu' is not in the folder"));
  EXPECT_THAT(error({"b.vtu"}), HasSubstr("does not exist"));
  EXPECT_THAT(error({"a.vtu", "a.vtu"}),
              HasSubstr("a.pvtu:3: the file lists the piece 'a.vtu' twice"));
  EXPECT_THAT(error({}), HasSubstr("lists no pieces"));
}

TEST_F(RecognizedFormats, MeditSolutionsAreReadAndWrittenBeside) {
  const auto in = file_with("a.mesh", square_medit);
  file_with("a.sol",
            "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n4\n2 1 3\n1 2 0 2\n2 2 0 2\n"
            "3 2 0 2\n4 2 0.5 2\nSolAtQuadrilaterals\n1\n1 2\n7 8\nEnd\n");
  const MeshFile read = read_mesh(in);
  EXPECT_THAT(read.notes, ElementsAre("the solution a.sol next to the mesh is read with it"));
  const FileContent& content = *topology(read).labels().content;
  ASSERT_EQ(content.node_fields.size(), 2u);
  EXPECT_EQ(content.node_fields[1].n_components, 3u);
  EXPECT_EQ(content.node_fields[1].number(10), 0.5);
  ASSERT_EQ(content.element_fields.size(), 1u);
  EXPECT_EQ(content.element_fields[0].number(1), 8.0);
  EXPECT_THAT(losses(file("b.mesh"), read.mesh), IsEmpty());
  write_mesh(file("b.mesh"), read.mesh);
  EXPECT_EQ(content_of(file("b.sol")), content_of(file("a.sol")));

  file_with("a.sol", "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n3\n1 1\n1\n2\n3\nEnd\n");
  file_with("a.solb", "x");
  EXPECT_THAT(read_mesh(in).notes,
              ElementsAre(HasSubstr("a.solb next to the mesh is left out, as it is binary"),
                          HasSubstr("is left out: it has 3 rows for 4 Vertices")));
}

}  // namespace
}  // namespace smoothfem
