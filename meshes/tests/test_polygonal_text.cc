// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/mesh_file.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using PolygonalText = FileTest;

const std::string title = "planar_polygonal_mesh\n";
const std::string nodes = "nodes 4\n0 0\n1 0\n+1.0e0 1\n0 1\n";
const std::string polygons = "polygons 2\n3 0 1 2\n3 0 2 3\n";
const std::string fixed = "fixed_node_indices 1\n2\n";

TEST_F(PolygonalText, ReadsNodesPolygonsFixedNodesAndLines) {
  const PlanarFile read = read_planar(file_with("a.mesh", title + "\n" + nodes + polygons + fixed));
  EXPECT_EQ(read.mesh.copied_coordinates()[2], Point<2>(1, 1));
  EXPECT_EQ(read.mesh.topology().free_nodes(), (std::vector<NodeIndex>{0, 1, 3}));
  EXPECT_EQ(read.cell_lines, (std::vector<std::size_t>{9, 10}));
}

TEST_F(PolygonalText, RoundTripKeepsEveryBit) {
  std::vector<bool> fixed_flags(10, false);
  fixed_flags[3] = fixed_flags[8] = true;
  const PlanarMesh mesh = mixed_mesh(true, {}, fixed_flags);
  write_mesh(file("a.mesh"), mesh);
  expect_same_mesh(read_planar(file("a.mesh")).mesh, mesh);
  write_mesh(file("b.mesh"), read_planar(file("a.mesh")).mesh);
  EXPECT_EQ(content_of(file("a.mesh")), content_of(file("b.mesh")));
}

TEST_F(PolygonalText, WritesTheLayoutOfThePublishedFiles) {
  write_mesh(file("b.mesh"),
             read_planar(file_with("a.mesh", title + nodes + polygons + fixed)).mesh);
  const std::string text = content_of(file("b.mesh"));
  EXPECT_THAT(text, StartsWith("planar_polygonal_mesh\nnodes 4\n"
                               "+0.00000000000000000e+00 +0.00000000000000000e+00\n"));
  EXPECT_THAT(text, HasSubstr("\npolygons 2\n3 0 1 2\n3 0 2 3\nfixed_node_indices 1\n2\n"
                              "polygon_mean_ratio_quality_numbers 2\n+8.6602540378443"));
}

TEST_F(PolygonalText, ReadsInvalidCellsAndNamesTheirLine) {
  const auto path = file_with("a.mesh", title + nodes + "polygons 2\n3 0 1 2\n3 0 3 2\n" + fixed);
  const PlanarFile read = read_planar(path, {.turns_over = false});
  EXPECT_THAT(input_error_of([&] { require_valid(read.mesh, path.string(), read.cell_lines); }),
              testing::AllOf(StartsWith(path.string() + ":9: "), HasSubstr("clockwise")));
}

struct BadText {
  std::string name, content;
  std::size_t line;
  std::string message;
  friend void PrintTo(const BadText& parameter, std::ostream* out) { *out << parameter.name; }
};

class BadPolygonalText : public FileTest, public ::testing::WithParamInterface<BadText> {};

TEST_P(BadPolygonalText, IsRefusedWithPositionAndReason) {
  const auto path = file_with("bad.mesh", GetParam().content);
  const std::string message = input_error_of([&] { read_planar(path); });
  EXPECT_THAT(message, StartsWith(path.string() + ":" + std::to_string(GetParam().line) + ": "));
  EXPECT_THAT(message, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    PolygonalText, BadPolygonalText,
    ::testing::Values(
        BadText{"medit", "MeshVersionFormatted 1\nVertices\n", 2,
                "the section Vertices comes before the dimension"},
        BadText{"medit_required", "MeshVersionFormatted 2\nDimension 2\nRequiredVertices 1\n1\n", 3,
                "the section RequiredVertices comes before Vertices"},
        BadText{"binary", std::string("\x7f\0ELF\1\n", 7), 1, "the format of this file is unknown"},
        BadText{"title_only", title, 1, "ends before the section 'nodes'"},
        BadText{"junk_after_title", "planar_polygonal_mesh 2\n", 1, "unexpected '2'"},
        BadText{"cut_in_nodes", title + "nodes 4\n0 0\n1 0\n", 4, "before node 3 of 4"},
        BadText{"cut_in_a_line", title + "nodes 4\n0 0\n1", 4, "the y coordinate is missing"},
        BadText{"huge_count", title + "nodes 4000000000\n0 0\n", 2, "more than the file has"},
        BadText{"negative_count", title + "nodes -4\n", 2, "not an integer"},
        BadText{"no_count", title + "nodes\n", 2, "the count of nodes is missing"},
        BadText{"nan", title + "nodes 4\n0 0\n1 nan\n", 4, "'nan', which is not finite"},
        BadText{"infinity", title + "nodes 4\n0 0\n-inf 0\n", 4, "not finite"},
        BadText{"overflow", title + "nodes 4\n0 0\n1e999 0\n", 4, "not finite"},
        BadText{"junk_number", title + "nodes 4\n0 0\n1 0x\n", 4, "'0x', which is not a number"},
        BadText{"three_coordinates", title + "nodes 4\n0 0 0\n", 3, "unexpected '0'"},
        BadText{"too_few_nodes", title + "nodes 5\n0 0\n1 0\n1 1\n0 1\npolygons 1\n", 7,
                "not a number"},
        BadText{"too_many_nodes", title + "nodes 3\n0 0\n1 0\n1 1\n0 1\npolygons 1\n", 6,
                "expected 'polygons'"},
        BadText{"two_gon", title + nodes + "polygons 1\n2 0 1\n", 8, "needs at least 3"},
        BadText{"short_row", title + nodes + "polygons 1\n4 0 1 2\n", 8,
                "node index 4 of 4 is missing"},
        BadText{"long_row", title + nodes + "polygons 1\n3 0 1 2 3\n", 8, "unexpected '3'"},
        BadText{"index", title + nodes + "polygons 1\n3 0 1 4\n" + fixed, 8, "must be below 4"},
        BadText{"negative_index", title + nodes + "polygons 1\n3 0 1 -2\n", 8, "not an integer"},
        BadText{"twice", title + nodes + "polygons 2\n3 0 1 2\n3 0 2 2\n" + fixed, 9,
                "cell 1 names node 2 more than once"},
        BadText{"three_at_an_edge",
                title + nodes + "polygons 3\n3 0 1 2\n3 0 2 3\n4 0 2 1 3\n" + fixed, 10,
                "at most two planar cells share an edge"},
        BadText{"no_fixed", title + nodes + polygons, 9, "the section 'fixed_node_indices'"},
        BadText{"fixed_index", title + nodes + polygons + "fixed_node_indices 1\n4\n", 11,
                "the fixed node index is 4"},
        BadText{"cut_in_fixed", title + nodes + polygons + "fixed_node_indices 2\n1\n", 11,
                "before fixed node 2 of 2"},
        BadText{"junk_at_end", title + nodes + polygons + fixed + "3\n", 12,
                "expected 'polygon_mean_ratio_quality_numbers'"},
        BadText{"quality_count",
                title + nodes + polygons + fixed + "polygon_mean_ratio_quality_numbers 1\n1\n", 12,
                "1 quality numbers for 2 polygons"},
        BadText{"quality_junk",
                title + nodes + polygons + fixed + "polygon_mean_ratio_quality_numbers 2\n1\nx\n",
                14, "not a number"},
        BadText{
            "trailing",
            title + nodes + polygons + fixed + "polygon_mean_ratio_quality_numbers 2\n1\n1\nmore\n",
            15, "unexpected text"}),
    [](const auto& info) { return info.param.name; });

TEST_F(PolygonalText, DetectsEveryTruncationExceptAtALineEnd) {
  const std::string whole = title + nodes + polygons + "fixed_node_indices 2\n1\n2\n";
  for (std::size_t n = 1; n + 2 < whole.size(); ++n)
    EXPECT_NE(input_error_of([&] { read_planar(file_with("cut.mesh", whole.substr(0, n))); }), "")
        << n << " bytes";
}

TEST_F(PolygonalText, RefusesAMeshWithoutCells) {
  EXPECT_THAT(
      input_error_of([&] {
        read_planar(file_with("a.mesh", title + nodes + "polygons 0\nfixed_node_indices 0"));
      }),
      HasSubstr("a.mesh: the mesh has no cells"));
}

}  // namespace
}  // namespace smoothfem
