// SPDX-License-Identifier: GPL-3.0-or-later
// Files as VTK itself writes them, in every encoding, are read by our own readers.
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataWriter.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "meshes/tests/labelled_box.h"
#include "meshes/tests/mesh_tests.h"
#include "smoothing/tests/volume_meshes.h"

namespace smoothfem {
namespace {

using test::BoxCells;

void expect_same(const VolumeMesh& read, const VolumeMesh& mesh) {
  expect_same_mesh(read, mesh);
  EXPECT_EQ(read.topology().labels(), mesh.topology().labels());
}

template <class Array>
vtkNew<Array> numbers(const std::string& name, int n_components, vtkIdType n) {
  vtkNew<Array> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(n_components);
  array->SetNumberOfTuples(n);
  for (vtkIdType i = 0; i < n * n_components; ++i)
    array->SetValue(i, static_cast<typename Array::ValueType>(i % 97));
  return array;
}

/// One example of each of VTK's attributes, which readers have to skip.
void add_attributes(vtkDataSetAttributes& attributes, vtkIdType n) {
  attributes.SetScalars(numbers<vtkFloatArray>("scalars of it", 1, n));
  attributes.SetVectors(numbers<vtkDoubleArray>("vectors", 3, n));
  attributes.SetNormals(numbers<vtkFloatArray>("normals", 3, n));
  attributes.SetTCoords(numbers<vtkFloatArray>("texture", 2, n));
  attributes.SetTensors(numbers<vtkDoubleArray>("tensors", 9, n));
  attributes.SetGlobalIds(numbers<vtkIdTypeArray>("global", 1, n));
  attributes.SetPedigreeIds(numbers<vtkIdTypeArray>("pedigree", 1, n));
  auto named = numbers<vtkUnsignedCharArray>("bytes", 2, n);
  named->SetComponentName(0, "first");
  named->SetComponentName(1, "second one");
  attributes.AddArray(named);
  vtkNew<vtkStringArray> strings;
  strings->SetName("strings");
  for (vtkIdType i = 0; i < n; ++i)
    strings->InsertNextValue(i % 3 == 0 ? "" : std::string(static_cast<std::size_t>(i), 'x'));
  attributes.AddArray(strings);
}

class VtkEncodings : public FileTest {
 protected:
  /// The mesh in VTK's form, with attributes that are not read.
  vtkSmartPointer<vtkUnstructuredGrid> grid_of(const VolumeMesh& mesh) {
    write_mesh(file("written.vtu"), mesh);
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName(file("written.vtu").c_str());
    reader->Update();
    vtkSmartPointer<vtkUnstructuredGrid> grid = reader->GetOutput();
    add_attributes(*grid->GetPointData(), grid->GetNumberOfPoints());
    add_attributes(*grid->GetCellData(), grid->GetNumberOfCells());
    grid->GetFieldData()->AddArray(numbers<vtkDoubleArray>("time", 1, 1));
    return grid;
  }
};

using LegacyWriter = vtkUnstructuredGridWriter;

TEST_F(VtkEncodings, LegacyFilesOfBothVersionsInTextAndBinary) {
  const VolumeMesh mesh = labelled_box(BoxCells::mixed);
  const auto grid = grid_of(mesh);
  for (const int version : {static_cast<int>(LegacyWriter::VTK_LEGACY_READER_VERSION_4_2),
                            static_cast<int>(LegacyWriter::VTK_LEGACY_READER_VERSION_5_1)})
    for (const bool binary : {false, true}) {
      SCOPED_TRACE(std::to_string(version) + (binary ? " binary" : " text"));
      vtkNew<LegacyWriter> writer;
      writer->SetFileVersion(version);
      binary ? writer->SetFileTypeToBinary() : writer->SetFileTypeToASCII();
      writer->SetInputData(grid);
      writer->SetFileName(file("a.vtk").c_str());
      ASSERT_EQ(writer->Write(), 1);
      const VolumeMesh read = read_volume(file("a.vtk"));
      EXPECT_EQ(read.topology().cells(), mesh.topology().cells());
      EXPECT_EQ(read.topology().labels(), mesh.topology().labels());
      EXPECT_EQ(nodes_free_but_for_interfaces(read.topology()), mesh.topology().free_nodes());
      for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)  // VTK's text has 11 digits
        EXPECT_LE((read.coordinates()[i] - mesh.coordinates()[i]).norm(), binary ? 0.0 : 1e-10);
    }
}

TEST_F(VtkEncodings, VtkFindsTheRolesOfItsArraysAgain) {
  const auto grid = grid_of(labelled_box(BoxCells::mixed));
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  writer->SetFileName(file("a.vtu").c_str());
  ASSERT_EQ(writer->Write(), 1);
  const AnyMesh mesh = read_mesh(file("a.vtu")).mesh;
  const auto expect_roles = [](vtkDataSetAttributes& read, vtkDataSetAttributes& of_file) {
    for (int role = 0; role < vtkDataSetAttributes::NUM_ATTRIBUTES; ++role) {
      auto* array = of_file.GetAbstractAttribute(role);
      if (!array) continue;
      SCOPED_TRACE(vtkDataSetAttributes::GetAttributeTypeAsString(role));
      ASSERT_NE(read.GetAbstractAttribute(role), nullptr);
      EXPECT_STREQ(read.GetAbstractAttribute(role)->GetName(), array->GetName());
    }
  };
  const auto expect_all = [&](vtkUnstructuredGrid& read) {
    expect_roles(*read.GetPointData(), *grid->GetPointData());
    expect_roles(*read.GetCellData(), *grid->GetCellData());
  };
  for (const bool binary : {false, true}) {
    write_mesh(file("b.vtk"), mesh, {}, {.binary = binary});
    vtkNew<vtkUnstructuredGridReader> legacy;
    legacy->SetFileName(file("b.vtk").c_str());
    legacy->Update();
    expect_all(*legacy->GetOutput());
  }
  write_mesh(file("b.vtu"), mesh);
  vtkNew<vtkXMLUnstructuredGridReader> xml;
  xml->SetFileName(file("b.vtu").c_str());
  xml->Update();
  expect_all(*xml->GetOutput());
}

TEST_F(VtkEncodings, LegacyPolygonalData) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int i = 0; i < 9; ++i) points->InsertNextPoint(i % 3, i / 3, 0.0);
  vtkNew<vtkCellArray> vertices, lines, polygons;
  vertices->InsertNextCell({4});
  lines->InsertNextCell({0, 1, 2});
  lines->InsertNextCell({0, 1});
  polygons->InsertNextCell({0, 1, 4, 3});
  polygons->InsertNextCell({1, 2, 4});
  polygons->InsertNextCell({3, 4, 5, 8, 7, 6});
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetVerts(vertices);
  data->SetLines(lines);
  data->SetPolys(polygons);
  auto tags = numbers<vtkDoubleArray>("physical_tag", 1, 6);  // 0, 1, 2, ...
  data->GetCellData()->AddArray(tags);
  add_attributes(*data->GetPointData(), 9);
  for (const int version : {static_cast<int>(LegacyWriter::VTK_LEGACY_READER_VERSION_4_2),
                            static_cast<int>(LegacyWriter::VTK_LEGACY_READER_VERSION_5_1)})
    for (const bool binary : {false, true}) {
      SCOPED_TRACE(std::to_string(version) + (binary ? " binary" : " text"));
      vtkNew<vtkPolyDataWriter> writer;
      writer->SetFileVersion(version);
      binary ? writer->SetFileTypeToBinary() : writer->SetFileTypeToASCII();
      writer->SetInputData(data);
      writer->SetFileName(file("a.vtk").c_str());
      ASSERT_EQ(writer->Write(), 1);
      const PlanarFile read = read_planar(file("a.vtk"));
      const MeshLabels& labels = read.mesh.topology().labels();
      EXPECT_EQ(read.mesh.topology().cells().entries(),
                (std::vector<NodeIndex>{0, 1, 4, 3, 1, 2, 4, 3, 4, 5, 8, 7, 6}));
      EXPECT_EQ(labels.cell_tags, (std::vector<int>{3, 4, 5}));
      EXPECT_EQ(labels.facets.entries(), (std::vector<NodeIndex>{0, 1}));
      EXPECT_EQ(labels.facet_tags, (std::vector<int>{2}));
    }
}

constexpr int base64_appended = vtkXMLWriter::Appended + 1;

class VtuEncodings : public VtkEncodings,
                     public ::testing::WithParamInterface<std::tuple<int, int, int, int>> {};

TEST_P(VtuEncodings, AreRead) {
  const auto [mode, compressor, header, byte_order] = GetParam();
  const VolumeMesh mesh = labelled_box(BoxCells::mixed);
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(grid_of(mesh));
  writer->SetFileName(file("a.vtu").c_str());
  writer->SetDataMode(std::min(mode, static_cast<int>(vtkXMLWriter::Appended)));
  writer->SetEncodeAppendedData(mode == base64_appended);
  writer->SetCompressorType(compressor);
  writer->SetBlockSize(1000);  // several blocks
  writer->SetHeaderType(header);
  writer->SetByteOrder(byte_order);
  ASSERT_EQ(writer->Write(), 1);
  const VolumeMesh read = read_volume(file("a.vtu"));
  if (mode != vtkXMLWriter::Ascii) return expect_same(read, mesh);
  EXPECT_EQ(read.topology().cells(), mesh.topology().cells());
  EXPECT_EQ(read.topology().labels(), mesh.topology().labels());
}

INSTANTIATE_TEST_SUITE_P(
    Vtk, VtuEncodings,
    ::testing::Combine(::testing::Values(vtkXMLWriter::Ascii, vtkXMLWriter::Binary,
                                         vtkXMLWriter::Appended, base64_appended),
                       ::testing::Values(vtkXMLWriter::NONE, vtkXMLWriter::ZLIB, vtkXMLWriter::LZ4,
                                         vtkXMLWriter::LZMA),
                       ::testing::Values(vtkXMLWriter::UInt32, vtkXMLWriter::UInt64),
                       ::testing::Values(vtkXMLWriter::LittleEndian, vtkXMLWriter::BigEndian)));

/// Pieces as parallel programs write them.
TEST_F(VtkEncodings, PiecesAreOneMesh) {
  const auto piece = [](int first, const std::string& fixed) {
    const std::string x[] = {std::to_string(first), std::to_string(first + 1)};
    return "<Piece NumberOfPoints='4' NumberOfCells='1'><PointData><DataArray type='Int8' "
           "Name='fixed' format='ascii'>" +
           fixed +
           "</DataArray></PointData><Points><DataArray type='Float32' NumberOfComponents='3' "
           "format='ascii'>" +
           x[0] + " 0 0 " + x[1] + " 0 0 " + x[1] + " 1 0 " + x[0] +
           " 1 0</DataArray></Points><Cells><DataArray type='Int32' Name='connectivity'>0 1 2 3"
           "</DataArray><DataArray type='Int32' Name='offsets'>4</DataArray><DataArray "
           "type='UInt8' Name='types'>9</DataArray></Cells></Piece>\n";
  };
  const std::string nothing =
      "<Piece NumberOfPoints='0' NumberOfCells='0'><Points><DataArray type='Float32' "
      "NumberOfComponents='3' format='appended' offset='9'/></Points></Piece>";
  const PlanarFile read = read_planar(file_with(
      "a.vtu",
      "<?xml version='1.0'?><!-- two > one -->\n<VTKFile type='UnstructuredGrid'>"
      "<UnstructuredGrid>" +
          piece(0, "1 0 0 1") + nothing + piece(7, "0 0 1 1") + "</UnstructuredGrid></VTKFile>\n"));
  EXPECT_EQ(read.mesh.topology().cells().entries(),
            (std::vector<NodeIndex>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(read.mesh.coordinates()[5], Point<2>(8, 0));
  EXPECT_EQ(read.mesh.topology().free_nodes(), (std::vector<NodeIndex>{1, 2, 4, 5}));
}

}  // namespace
}  // namespace smoothfem
