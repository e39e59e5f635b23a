// SPDX-License-Identifier: GPL-3.0-or-later
// What files claim does not decide what reading them takes.
#include <chrono>

#include "meshes/tests/mesh_tests.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

struct Damaged {
  std::string name, extension, content, message;
  friend void PrintTo(const Damaged& parameter, std::ostream* out) { *out << parameter.name; }
};

class DamagedFile : public FileTest, public ::testing::WithParamInterface<Damaged> {};

TEST_P(DamagedFile, IsRefusedWithLittleTimeAndMemory) {
  const auto path = file_with("bad" + GetParam().extension, GetParam().content);
  const auto start = std::chrono::steady_clock::now();
  const std::string message = [&] {
    const LittleMemory memory(rlim_t{64} << 20);
    return input_error_of([&] { read_mesh(path); });
  }();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  EXPECT_THAT(message, StartsWith(path.string() + ":"));
  EXPECT_THAT(message, HasSubstr(GetParam().message));
  for (const std::string raw : {"vtk", "0x", "std::", "\n"})
    EXPECT_THAT(message.substr(path.string().size()), Not(HasSubstr(raw)));
}

const std::string msh_head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string msh_nodes = "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n";

const std::string vtk_head = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n";
const std::string vtk_points = "POINTS 3 double\n0 0 0 1 0 0 0 1 0\n";
const std::string vtk_cells = "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n";
const std::string vtk5_head = "# vtk DataFile Version 5.1\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n";

/// One triangle. Each part may be damaged.
struct Vtu {
  std::string n_points = "3", n_cells = "1", components = "3", points = "0 0 0 1 0 0 0 1 0";
  std::string nodes = "0 1 2", offsets = "3", types = "5", format = "ascii", attributes = "",
              more = "";

  std::string text() const {
    const auto array = [&](const std::string& name, const std::string& type,
                           const std::string& content, const std::string& n_components) {
      return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
             n_components + "\" format=\"" + format + "\">" + content + "</DataArray>\n";
    };
    return "<VTKFile type=\"UnstructuredGrid\" " + attributes +
           "><UnstructuredGrid>\n<Piece NumberOfPoints=\"" + n_points + "\" NumberOfCells=\"" +
           n_cells + "\">\n<Points>" + array("Points", "Float64", points, components) +
           "</Points>\n<Cells>" + array("connectivity", "Int64", nodes, "1") +
           array("offsets", "Int64", offsets, "1") + array("types", "UInt8", types, "1") +
           "</Cells>\n" + more + "</Piece></UnstructuredGrid></VTKFile>\n";
  }
};

/// The header of 1000 blocks of 2^30 bytes, each of one byte when compressed.
const std::string huge_blocks = [] {
  std::string header = "6AMAAAAAAEAAAAAA";
  for (int block = 0; block < 1000; block += 3) header += "AQAAAAEAAAABAAAA";
  return header;
}();

INSTANTIATE_TEST_SUITE_P(
    Files, DamagedFile,
    ::testing::Values(
        Damaged{"msh_name_of_dimension_9", ".msh",
                msh_head + "$PhysicalNames\n1\n9 1 \"a\"\n$EndPhysicalNames\n" + msh_nodes +
                    "$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n",
                "6: the physical group's dimension is 9, but must be from 0 to 3"},
        Damaged{"msh_too_few_nodes", ".msh",
                msh_head + msh_nodes + "$Elements\n1\n1 2 2 0 1 1 2\n$EndElements\n", ":12: "},
        Damaged{"msh_huge_node_data", ".msh",
                msh_head + msh_nodes +
                    "$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n$NodeData\n1\n\"a\"\n0\n3\n0\n1\n"
                    "1000000000\n1 0.5\n",
                "the file ends before $EndNodeData"},
        Damaged{"msh_huge_counts", ".msh", msh_head + "$Nodes\n4000000000\n1 0 0 0\n",
                "before node 2 of 4000000000"},

        Damaged{"vtk_huge_field", ".vtk", vtk_head + "FIELD F 1000000000\n" + vtk_points,
                ":6: the number of values is 'double', which is not an integer"},
        Damaged{"vtk_huge_array", ".vtk",
                vtk_head + "FIELD F 1\nx 1 1000000000 double\n1 2\n" + vtk_points + vtk_cells,
                ":6: 1000000000 values are announced, more than the file has"},
        Damaged{"vtk_huge_array_later", ".vtk",
                vtk_head + vtk_points + vtk_cells +
                    "POINT_DATA 3\nFIELD F 1\nx 1000000000 1000000000 double\n1 2 3\n",
                ":13: 1000000000 values are announced, more than the file has"},
        Damaged{"vtk_huge_strings", ".vtk",
                vtk_head + "FIELD F 1\nx 1 1000000000 string\n1 2\n" + vtk_points + vtk_cells,
                ":6: 125000000 values are announced, more than the file has"},
        Damaged{"vtk_huge_components_of_nothing", ".vtk",
                vtk_head + "FIELD F 1\nx 18446744073709551614 7 bit\n1 2\n" + vtk_points, ":6: "},
        Damaged{"vtk_huge_points", ".vtk", vtk_head + "POINTS 1000000000 double\n0 0 0\n",
                "1000000000 points are announced, more than the file has"},
        Damaged{"vtk_huge_cells", ".vtk", vtk_head + vtk_points + "CELLS 1 4000000000\n3 0 1 2\n",
                "4000000000 integers are announced, more than the file has"},
        Damaged{"vtk_more_rows_than_integers", ".vtk",
                vtk_head + vtk_points + "CELLS 4000000000 4\n3 0 1 2\n",
                "does not have the rows it announces"},
        Damaged{"vtk_huge_row", ".vtk",
                vtk_head + vtk_points + "CELLS 1 4\n2000000000 0 1 2\nCELL_TYPES 1\n5\n",
                "does not have the rows it announces"},
        Damaged{"vtk_cell_type", ".vtk",
                vtk_head + vtk_points + "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n-5\n",
                "cell 0 has the VTK type -5, which there is not"},
        Damaged{"vtk_huge_types", ".vtk",
                vtk_head + vtk_points + "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1000000000\n5\n",
                "1000000000 cell types are announced"},
        Damaged{"vtk_offsets_descend", ".vtk",
                vtk5_head + vtk_points +
                    "CELLS 3 6\nOFFSETS int\n0 7 6\nCONNECTIVITY int\n0 1 2 0 1 2\n",
                "does not have the rows it announces"},
        Damaged{"vtk_real_offsets", ".vtk", vtk5_head + vtk_points + "CELLS 2 3\nOFFSETS double\n",
                "must be integers"},
        Damaged{"vtk_huge_colours", ".vtk",
                vtk_head + vtk_points + vtk_cells + "CELL_DATA 1\nLOOKUP_TABLE x 1000000000\n1\n",
                "1000000000 values are announced"},
        Damaged{"vtk_other_number_of_values", ".vtk",
                vtk_head + vtk_points + vtk_cells + "POINT_DATA 5\n",
                "there are 5 values announced for 3 points"},

        Damaged{"vtu_components", ".vtu", Vtu{.components = "1000000000"}.text(),
                "the array 'Points' has 1000000000 components, but points have 3"},
        Damaged{"vtu_huge_points", ".vtu", Vtu{.n_points = "1000000000"}.text(),
                "has fewer values than the 3000000000 announced"},
        Damaged{"vtu_endless_points", ".vtu", Vtu{.n_points = "18446744073709551615"}.text(),
                "would have too many points"},
        Damaged{"vtu_huge_cells", ".vtu", Vtu{.n_cells = "1000000000"}.text(),
                "the array 'offsets' has fewer values than the 1000000000 announced"},
        Damaged{"vtu_huge_offset", ".vtu", Vtu{.offsets = "3000000000"}.text(),
                "the array 'connectivity' has fewer values than the 3000000000 announced"},
        Damaged{"vtu_negative_offset", ".vtu", Vtu{.offsets = "-3"}.text(),
                "the array 'offsets' does not ascend at cell 0"},
        Damaged{"vtu_node", ".vtu", Vtu{.nodes = "0 1 -9000000000"}.text(),
                "cell 0 names point -9000000000"},
        Damaged{"vtu_cell_type", ".vtu", Vtu{.types = "300"}.text(),
                "the array 'types' has 300, which is not a VTK cell type"},
        Damaged{"vtu_unknown_cell_type", ".vtu", Vtu{.types = "250"}.text(), "the VTK type 250"},
        Damaged{"vtu_no_base64", ".vtu", Vtu{.points = "A?==", .format = "binary"}.text(),
                "the array 'Points' has no header"},
        Damaged{"vtu_base64_too_short", ".vtu",
                Vtu{.points = "SAAAAAAAAAAAAAAA", .format = "binary"}.text(),
                "the array 'Points' announces more bytes than there are"},
        Damaged{"vtu_base64_of_other_size", ".vtu",
                Vtu{.points = "CAAAAAAAAAAAAAAA", .format = "binary"}.text(),
                "the array 'Points' has 8 bytes, but its 9 values need 8 bytes each"},
        Damaged{"vtu_huge_blocks", ".vtu",
                Vtu{.n_points = "44739242",
                    .points = huge_blocks,
                    .format = "binary",
                    .attributes = "compressor=\"vtkZLibDataCompressor\""}
                    .text(),
                "the array 'Points' has 1073741824000 bytes"},
        Damaged{"vtu_bomb", ".vtu",
                Vtu{.n_points = "44739242",  // 2^30 bytes and 8 less
                    .points = "AQAAAPD//z/w//8/BAAAAAAAAAA=",
                    .format = "binary",
                    .attributes = "compressor=\"vtkZLibDataCompressor\""}
                    .text(),
                "would be more than 100 times as large as the file when decompressed"},
        Damaged{"vtu_compressor", ".vtu",
                Vtu{.format = "binary", .attributes = "compressor=\"Other\""}.text(),
                "the array 'Points' is compressed by 'Other', which is not known"},
        Damaged{"vtu_appended_offset", ".vtu", Vtu{.format = "appended"}.text(),
                "the array 'Points' "},
        Damaged{"vtu_huge_names", ".vtu",
                Vtu{.more = "</Piece><FieldData><DataArray type=\"Int8\" Name=\"physical_name\" "
                            "NumberOfTuples=\"4000000000\" NumberOfComponents=\"4000000000\">1"
                            "</DataArray></FieldData><Piece>"}
                    .text(),
                "the array 'physical_name' has fewer values"},
        Damaged{"vtu_tags_cross", ".vtu", "<VTKFile type=\"UnstructuredGrid\"><a><b></a></b>\n",
                "1: </a> ends no element"},
        Damaged{"vtu_two_meshes", ".vtu", Vtu().text() + Vtu().text(),
                ":10: the file has a second root element"},
        Damaged{"vtu_cut_in_a_tag", ".vtu", "<VTKFile type=\"UnstructuredGrid",
                "the attribute 'type' is not in quotes"}),
    [](const auto& info) { return info.param.name; });

/// Sets of every second, third, ... node; as many sets as nodes.
TEST_F(FileTest, ReadsManySetsOfManyNodesQuickly) {
  constexpr int n = 20000;
  std::string nodes = "*NODE\n", elements = "*ELEMENT, TYPE=S4\n",
              fixed = "*NSET, NSET=SMOOTHFEM_FIXED, GENERATE\n",
              sets = "*ELSET, ELSET=a, GENERATE\n";
  for (int i = 1; i <= n; ++i) {
    const std::string label = std::to_string(i), other = std::to_string(i + n);
    nodes += label + "," + label + ",0\n" + other + "," + label + ",1\n";
    if (i < n)
      elements += label + "," + label + "," + std::to_string(i + 1) + "," +
                  std::to_string(i + n + 1) + "," + other + "\n";
    for (std::string* text : {&fixed, &sets})
      for (const std::string last : {"99998", "99999"})
        *text += "2," + last + "," + std::to_string(i + 1) + "\n";
  }
  const auto path = file_with("a.inp", nodes + elements + fixed + sets);
  const auto start = std::chrono::steady_clock::now();
  const PlanarFile read = read_planar(path);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  std::vector<NodeIndex> free = {0, 2};  // 1 before the ranges, 3 between the first two of each
  for (NodeIndex label = 4; label <= 2 * n; ++label) {
    bool is_free = true;
    for (NodeIndex step = 2; step <= n + 1 && is_free; ++step) is_free = (label - 2) % step != 0;
    if (is_free) free.push_back(label - 1);
  }
  EXPECT_EQ(nodes_free_but_for_interfaces(read.mesh.topology()), free);
  EXPECT_EQ(read.mesh.topology().labels().cell_tags[0], 0);
  EXPECT_EQ(read.mesh.topology().labels().cell_tags[1], 1);
}

// --- Input that every format refuses -------------------------------------------------------------

/// Triangles, or tetrahedra, as a text file.
std::string file_of(const std::string& extension, const std::vector<std::string>& points,
                    const std::vector<std::vector<int>>& cells) {
  const bool tetrahedra = cells[0].size() == 4;
  const std::string n_points = std::to_string(points.size()),
                    n_cells = std::to_string(cells.size()), size = tetrahedra ? "4" : "3";
  const auto rows = [&](const std::string& head, int first, const std::string& separator,
                        bool numbered, const std::string& tail) {
    std::string text;
    int number = 0;
    for (const auto& cell : cells) {
      text += numbered ? std::to_string(++number) + separator : "";
      text += head;
      for (std::size_t k = 0; k < cell.size(); ++k)
        text += (k > 0 ? separator : "") + std::to_string(cell[k] + first);
      text += tail + "\n";
    }
    return text;
  };
  const auto nodes = [&](const std::string& separator, bool numbered, const std::string& tail) {
    std::string text;
    int number = 0;
    for (std::string point : points) {
      std::replace(point.begin(), point.end(), ' ', separator[0]);
      text += (numbered ? std::to_string(++number) + separator : "") + point + tail + "\n";
    }
    return text;
  };
  if (extension == ".msh")
    return msh_head + "$Nodes\n" + n_points + "\n" + nodes(" ", true, "") +
           "$EndNodes\n$Elements\n" + n_cells + "\n" +
           rows(tetrahedra ? "4 0 " : "2 0 ", 1, " ", true, "") + "$EndElements\n";
  if (extension == ".vtk") {
    std::string types;
    for (std::size_t c = 0; c < cells.size(); ++c) types += tetrahedra ? "10\n" : "5\n";
    return vtk_head + "POINTS " + n_points + " double\n" + nodes(" ", false, "") + "CELLS " +
           n_cells + " " + std::to_string(cells.size() * (cells[0].size() + 1)) + "\n" +
           rows(size + " ", 0, " ", false, "") + "CELL_TYPES " + n_cells + "\n" + types;
  }
  if (extension == ".vtu") {
    Vtu vtu{.n_points = n_points,
            .n_cells = n_cells,
            .points = nodes(" ", false, ""),
            .nodes = rows("", 0, " ", false, ""),
            .offsets = "",
            .types = ""};
    for (std::size_t c = 1; c <= cells.size(); ++c) {
      vtu.offsets += std::to_string(c * cells[0].size()) + " ";
      vtu.types += tetrahedra ? "10 " : "5 ";
    }
    return vtu.text();
  }
  if (extension == ".inp")
    return "*NODE\n" + nodes(",", true, "") + "*ELEMENT, TYPE=" + (tetrahedra ? "C3D4\n" : "S3\n") +
           rows("", 1, ",", true, "");
  return "MeshVersionFormatted 2\nDimension 3\nVertices " + n_points + "\n" +
         nodes(" ", false, " 0") + (tetrahedra ? "Tetrahedra " : "Triangles ") + n_cells + "\n" +
         rows("", 1, " ", false, " 0") + "End\n";
}

class EveryTextFormat : public FileTest, public ::testing::WithParamInterface<std::string> {
 protected:
  std::string message(const std::vector<std::string>& points,
                      const std::vector<std::vector<int>>& cells) const {
    const auto path = file_with("a" + GetParam(), file_of(GetParam(), points, cells));
    return input_error_of([&] { read_mesh(path); });
  }
};

const std::vector<std::string> square_corners = {"0 0 0", "1 0 0", "1 1 0", "0 1 0"},
                               roof_corners = {"0 0 0", "1 0 .5", "1 1 0", "0 1 .5"},
                               corner = {"0 0 0", "1 0 0", "0 1 0", "0 0 1", "1 1 1"};

TEST_P(EveryTextFormat, RefusesDuplicateCells) {
  for (const auto& points : {square_corners, roof_corners}) {
    EXPECT_EQ(message(points, {{0, 1, 2}, {0, 2, 3}}), "");
    EXPECT_THAT(message(points, {{0, 1, 2}, {0, 1, 2}}),
                HasSubstr("cell 1 has the same nodes as cell 0; remove one of them"));
    EXPECT_THAT(message(points, {{0, 2, 3}, {0, 1, 2}, {2, 1, 0}}),
                HasSubstr("cell 2 has the same nodes as cell 1"));
  }
  EXPECT_EQ(message(corner, {{0, 1, 2, 3}, {1, 2, 3, 4}}), "");
  EXPECT_THAT(message(corner, {{0, 1, 2, 3}, {1, 2, 3, 4}, {3, 1, 2, 0}}),
              HasSubstr("cell 2 has the same nodes as cell 0"));
}

TEST_P(EveryTextFormat, RefusesCoordinatesWhoseSizesOverflow) {
  for (const std::string large : {"1e51", "-1e100", "1e308"})
    for (const std::string& point : {large + " 0 0", "0 " + large + " 0", "0 0 " + large}) {
      auto points = corner;
      points[3] = point;
      EXPECT_THAT(message(points, {{0, 1, 2, 3}, {1, 2, 3, 4}}),
                  ::testing::ContainsRegex("node [34] has the coordinate -?1e\\+[0-9]+, so large"));
    }
  for (const std::string no_number : {"nan", "inf", "1e999"}) {
    auto points = corner;
    points[3] = "0 0 " + no_number;
    EXPECT_THAT(message(points, {{0, 1, 2, 3}, {1, 2, 3, 4}}), HasSubstr("which is not finite"));
  }
}

INSTANTIATE_TEST_SUITE_P(Files, EveryTextFormat,
                         ::testing::Values(".msh", ".vtk", ".vtu", ".inp", ".mesh"),
                         [](const auto& info) { return info.param.substr(1); });

TEST_F(FileTest, RefusesNonFiniteCoordinatesInBinaryFiles) {
  for (const std::string extension : {".vtk", ".msh"}) {
    write_mesh(file("a" + extension), mixed_mesh(false));
    std::string content = content_of(file("a" + extension));
    const double known = 0.9 + 1e-16, no_number = std::numeric_limits<double>::infinity();
    std::string from(reinterpret_cast<const char*>(&known), sizeof known),
        to(reinterpret_cast<const char*>(&no_number), sizeof no_number);
    if (extension == ".vtk") {
      std::reverse(from.begin(), from.end());
      std::reverse(to.begin(), to.end());
    }
    const std::size_t at = content.find(from);
    ASSERT_NE(at, content.npos);
    content.replace(at, from.size(), to);
    const auto path = file_with("b" + extension, content);
    EXPECT_THAT(
        input_error_of([&] { read_mesh(path); }),
        ::testing::ContainsRegex("node [45] has the coordinate inf, which is not a finite"));
  }
}

}  // namespace
}  // namespace smoothfem
