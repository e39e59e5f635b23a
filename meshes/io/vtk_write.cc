#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <string>

#include "meshes/io/atomic_file.h"
#include "meshes/io/vtk_files.h"
#include "meshes/io/vtk_messages.h"
#include "smoothing/mesh/input_error.h"

namespace smoothfem {

namespace {

int vtk_type(ElementType type) {
  switch (type) {
    case ElementType::triangle:
      return VTK_TRIANGLE;
    case ElementType::quadrilateral:
      return VTK_QUAD;
    case ElementType::polygon:
      return VTK_POLYGON;
  }
  return VTK_EMPTY_CELL;
}

template <class Array, class Values>
void add_array(vtkDataSetAttributes& attributes, const std::string& name, const Values& values) {
  vtkNew<Array> array;
  array->SetName(name.c_str());
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    array->SetValue(static_cast<vtkIdType>(i), values[i]);
  attributes.AddArray(array);
}

void set_points(const PlanarMesh& mesh, vtkUnstructuredGrid& grid) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.n_nodes()));
  for (std::size_t i = 0; i < mesh.n_nodes(); ++i)
    points->SetPoint(static_cast<vtkIdType>(i), mesh.coordinates()[i].x(),
                     mesh.coordinates()[i].y(), 0.0);
  grid.SetPoints(points);
}

void set_cells(const Topology& topology, vtkUnstructuredGrid& grid) {
  std::vector<vtkIdType> nodes;
  grid.AllocateExact(static_cast<vtkIdType>(topology.n_cells()),
                     static_cast<vtkIdType>(topology.cells().n_entries()));
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    const auto row = topology.cell_nodes(c);
    nodes.assign(row.begin(), row.end());
    grid.InsertNextCell(vtk_type(topology.cell_type(c)), static_cast<vtkIdType>(nodes.size()),
                        nodes.data());
  }
}

vtkSmartPointer<vtkUnstructuredGrid> grid_of(const PlanarMesh& mesh, const MeshFields& fields) {
  const Topology& topology = mesh.topology();
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  set_points(mesh, *grid);
  set_cells(topology, *grid);
  std::vector<int> fixed(mesh.n_nodes());
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) fixed[i] = topology.is_fixed(i) ? 1 : 0;
  add_array<vtkIntArray>(*grid->GetPointData(), "fixed", fixed);
  if (!topology.labels().cell_tags.empty())
    add_array<vtkIntArray>(*grid->GetCellData(), "physical_tag", topology.labels().cell_tags);
  for (const auto& [name, values] : fields.point)
    add_array<vtkDoubleArray>(*grid->GetPointData(), name, values);
  for (const auto& [name, values] : fields.cell)
    add_array<vtkDoubleArray>(*grid->GetCellData(), name, values);
  return grid;
}

/// Into memory first: VTK does not notice every failed write, write_atomically does.
template <class Writer>
void run(Writer& writer, const std::filesystem::path& path, const PlanarMesh& mesh,
         const MeshFields& fields, std::string (*output_of)(Writer&)) {
  const VtkMessages messages;
  writer.SetInputData(grid_of(mesh, fields));
  writer.WriteToOutputStringOn();
  const bool written = writer.Write() == 1;
  const std::string message = messages.first();
  if (!written || !message.empty())
    throw InputError("cannot write " + path.string() +
                     ": VTK: " + (message.empty() ? "unknown error" : message));
  write_atomically(path, output_of(writer));
}

}  // namespace

void write_legacy_vtk(const std::filesystem::path& path, const PlanarMesh& mesh,
                      const MeshFields& fields, const MeshWriteOptions&) {
  vtkNew<vtkUnstructuredGridWriter> writer;
  writer->SetFileVersion(vtkUnstructuredGridWriter::VTK_LEGACY_READER_VERSION_4_2);
  writer->SetFileTypeToBinary();
  writer->SetHeader("smoothfem mesh");
  run<vtkUnstructuredGridWriter>(*writer, path, mesh, fields,
                                 [](vtkUnstructuredGridWriter& finished) -> std::string {
                                   return finished.GetOutputStdString();
                                 });
}

void write_vtu(const std::filesystem::path& path, const PlanarMesh& mesh, const MeshFields& fields,
               const MeshWriteOptions&) {
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetDataModeToBinary();
  writer->SetHeaderTypeToUInt64();
  writer->SetCompressorTypeToNone();
  run<vtkXMLUnstructuredGridWriter>(*writer, path, mesh, fields,
                                    [](vtkXMLUnstructuredGridWriter& finished) {
                                      return std::string(finished.GetOutputString());
                                    });
}

}  // namespace smoothfem
