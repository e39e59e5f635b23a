// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/mesh_file.h"
#include "meshes/io/vtu_series.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class VtkFormats : public FileTest, public ::testing::WithParamInterface<std::string> {};

TEST_P(VtkFormats, KeepsTagsOfCells) {
  MeshLabels labels;
  labels.cell_tags = {1, 2, 3, 4, 5};
  write_mesh(file("a" + GetParam()), mixed_mesh(true, labels));
  EXPECT_EQ(read_planar(file("a" + GetParam())).mesh.topology().labels(), labels);
}

TEST_P(VtkFormats, FieldsAreWrittenWithTheirNames) {
  MeshFields fields;
  fields.cell["mean_ratio"] = {.1, .2, .3, .4, .5};
  fields.point["solution"] = std::vector<double>(10, 1.0 / 3.0);
  write_mesh(file("a" + GetParam()), mixed_mesh(true), fields);
  const std::string content = content_of(file("a" + GetParam()));
  EXPECT_THAT(content, HasSubstr("mean_ratio"));
  EXPECT_THAT(content, HasSubstr("solution"));
  expect_same_mesh(read_planar(file("a" + GetParam())).mesh, mixed_mesh(true));
}

INSTANTIATE_TEST_SUITE_P(Vtk, VtkFormats, ::testing::Values(".vtk", ".vtu"),
                         [](const auto& info) { return info.param.substr(1); });

using Vtk = FileTest;

const std::string head = "# vtk DataFile Version 3.0\nsquare\nASCII\nDATASET UNSTRUCTURED_GRID\n";
const std::string points = "POINTS 4 double\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

TEST_F(Vtk, ReadsFixedTagsLinesAndPixels) {
  const PlanarFile read = read_planar(file_with(
      "a.vtk",
      head + "POINTS 6 double\n0 0 3\n1 0 3\n0 1 3\n1 1 3\n2 0 3\n2 1 3\n"
             "CELLS 5 18\n2 0 1\n4 0 1 2 3\n1 4\n4 1 4 5 3\n2 1 4\nCELL_TYPES 5\n3\n8\n1\n9\n3\n"
             "CELL_DATA 5\nSCALARS other int\nLOOKUP_TABLE default\n1 2 3 4 5\n"
             "SCALARS physical_tag int\nLOOKUP_TABLE default\n8 1 0 2 0\n"
             "POINT_DATA 6\nSCALARS fixed float\nLOOKUP_TABLE default\n0 1 0 0 0 2\n"));
  const Topology& topology = read.mesh.topology();
  EXPECT_EQ(topology.cells().entries(), (std::vector<NodeIndex>{0, 1, 3, 2, 1, 4, 5, 3}));
  EXPECT_EQ(mesh_quality(read.mesh).q_min, 1.0);
  EXPECT_EQ(nodes_free_but_for_interfaces(topology), (std::vector<NodeIndex>{0, 2, 3, 4}));
  EXPECT_EQ(topology.labels().cell_tags, (std::vector<int>{1, 2}));
  EXPECT_EQ(topology.labels().facets.entries(), (std::vector<NodeIndex>{0, 1}));
  EXPECT_EQ(topology.labels().facet_tags, (std::vector<int>{8}));
}

TEST_F(Vtk, ReadsPolygonalData) {
  const PlanarFile read =
      read_planar(file_with("a.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n" +
                                         points + "POLYGONS 2 8\n3 0 1 2\n3 0 2 3\n"));
  EXPECT_EQ(read.mesh.topology().cells().entries(), (std::vector<NodeIndex>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(mesh_quality(read.mesh).n_invalid, 0u);
}

std::string vtu(const std::string& connectivity, const std::string& types) {
  return "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
         "<UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"2\">\n"
         "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">"
         "0 0 0 1 0 0 1 1 0 0 1 0</DataArray></Points>\n"
         "<Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">" +
         connectivity +
         "</DataArray>\n<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3 6</DataArray>"
         "\n<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">" +
         types + "</DataArray></Cells>\n</Piece></UnstructuredGrid></VTKFile>\n";
}

TEST_F(Vtk, ReadsVtuAsText) {
  const PlanarFile read = read_planar(file_with("a.vtu", vtu("0 1 2 0 2 3", "5 7")));
  EXPECT_EQ(read.mesh.topology().cells().entries(), (std::vector<NodeIndex>{0, 1, 2, 0, 2, 3}));
}

TEST_F(Vtk, VtuIsInlineBase64OfDoublesWithoutCompression) {
  write_mesh(file("a.vtu"), mixed_mesh(true));
  const std::string content = content_of(file("a.vtu"));
  EXPECT_THAT(content, HasSubstr("header_type=\"UInt64\""));
  EXPECT_THAT(content, HasSubstr("type=\"Float64\" Name=\"Points\""));
  EXPECT_THAT(content, HasSubstr("format=\"binary\""));
  EXPECT_THAT(content, Not(HasSubstr("compressor")));
  EXPECT_THAT(content, Not(HasSubstr("appended")));
}

struct BadVtk {
  std::string name, extension, content, message;
  friend void PrintTo(const BadVtk& parameter, std::ostream* out) { *out << parameter.name; }
};

class BadVtkFile : public FileTest, public ::testing::WithParamInterface<BadVtk> {};

TEST_P(BadVtkFile, IsRefusedWithReasonAndNothingOnTheTerminal) {
  const auto path = file_with("bad" + GetParam().extension, GetParam().content);
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const std::string message = input_error_of([&] { read_planar(path); });
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_THAT(message, StartsWith(path.string() + ":"));
  EXPECT_THAT(message, HasSubstr(GetParam().message));
  EXPECT_THAT(message, Not(HasSubstr("\n")));
}

INSTANTIATE_TEST_SUITE_P(
    Vtk, BadVtkFile,
    ::testing::Values(
        BadVtk{"other_file", ".vtk", "solid cube\n", "this is not a legacy VTK file"},
        BadVtk{"only_title", ".vtk", "# vtk DataFile Version 3.0\n", ""},
        BadVtk{"no_cells", ".vtk", head + points, "the file has no cells"},
        BadVtk{"cut_points", ".vtk", head + "POINTS 4 double\n0 0 0\n1 0",
               ":7: the file ends before a coordinate; it is truncated"},
        BadVtk{"junk_points", ".vtk", head + "POINTS 4 double\n0 0 0\n1 0 x 1 1 1 0 0 1 0 0 1\n",
               ":7: a coordinate is 'x', which is not a number"},
        BadVtk{"cut_cells", ".vtk", head + points + "CELLS 2 8\n3 0 1 2\n3 0",
               ":12: the file ends before a cell; it is truncated"},
        BadVtk{"cut_types", ".vtk", head + points + "CELLS 2 8\n3 0 1 2\n3 0 2 3\nCELL_TYPES 2\n5",
               ""},
        BadVtk{"no_types", ".vtk", head + points + "CELLS 2 8\n3 0 1 2\n3 0 2 3\n", ""},
        BadVtk{"index", ".vtk", head + points + "CELLS 1 4\n3 0 1 4\nCELL_TYPES 1\n5\n",
               "cell 0 names point 4, but the file has only 4 points"},
        BadVtk{"negative_index", ".vtk", head + points + "CELLS 1 4\n3 0 1 -1\nCELL_TYPES 1\n5\n",
               "cell 0 names point -1"},
        BadVtk{"wrong_row", ".vtk", head + points + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n5\n",
               "cell 0 has 4 nodes, but its type has 3"},
        BadVtk{"size_beyond_rows", ".vtk",
               head + points + "CELLS 2 9\n3 0 1 2\n3 0 2 3\nCELL_TYPES 2\n5\n5\n", ""},
        BadVtk{"row_beyond_size", ".vtk", head + points + "CELLS 1 4\n9 0 1 2\nCELL_TYPES 1\n5\n",
               ""},
        BadVtk{"two_gon", ".vtk", head + points + "CELLS 1 3\n2 0 1\nCELL_TYPES 1\n7\n",
               "cell 0 has 2 nodes"},
        BadVtk{"nan", ".vtk",
               head + "POINTS 3 double\n0 0 0\nnan 0 0\n1 1 0\nCELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n"
                      "5\n",
               ""},
        BadVtk{"bezier", ".vtk",
               head + "POINTS 6 double\n0 0 0\n1 0 0\n0 1 0\n.5 0 0\n.5 .5 0\n0 .5 0\n"
                      "CELLS 1 7\n6 0 1 2 3 4 5\nCELL_TYPES 1\n76\n",
               "(vtkBezierTriangle) with 6 nodes; cells of this type or order cannot be read"},
        BadVtk{"image", ".vtk",
               "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 1\n"
               "ORIGIN 0 0 0\nSPACING 1 1 1\n",
               "no unstructured grid and no polygonal data"},
        BadVtk{"other_vtu", ".vtu", "<html></html>\n", "this is not a .vtu file"},
        BadVtk{"image_vtu", ".vtu", "<VTKFile type=\"ImageData\"></VTKFile>\n",
               "no unstructured grid"},
        BadVtk{"index_vtu", ".vtu", vtu("0 1 2 0 2 4", "5 5"), "cell 1 names point 4"},
        BadVtk{"short_vtu", ".vtu", vtu("0 1 2", "5 5"), ""},
        BadVtk{"type_vtu", ".vtu", vtu("0 1 2 0 2 3", "5"), ""}),
    [](const auto& info) { return info.param.name; });

using Series = FileTest;

TEST_F(Series, IsReadableAfterEveryStep) {
  VtuSeries series(file("run/smoothing.pvd"));
  for (int step = 0; step < 3; ++step) {
    series.add(10.0 * step, mixed_mesh(true));
    const std::string collection = content_of(file("run/smoothing.pvd"));
    EXPECT_THAT(collection, HasSubstr("timestep=\"" + std::to_string(10 * step) + "\""));
    EXPECT_THAT(collection,
                HasSubstr("file=\"smoothing/smoothing_00000" + std::to_string(step) + ".vtu\""));
    EXPECT_THAT(collection, HasSubstr("</VTKFile>"));
  }
  EXPECT_EQ(series.size(), 3u);
  expect_same_mesh(read_planar(file("run/smoothing/smoothing_000002.vtu")).mesh, mixed_mesh(true));
}

TEST_F(Series, RefusesOtherExtensionsAndTimes) {
  EXPECT_THAT(input_error_of([&] { VtuSeries(file("run.vtu")); }), HasSubstr(".pvd"));
  EXPECT_THAT(input_error_of([&] { VtuSeries(file("run.pvd")).add(0.0 / 0.0, mixed_mesh(true)); }),
              HasSubstr("not finite"));
}

}  // namespace
}  // namespace smoothfem
