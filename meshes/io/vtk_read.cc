// SPDX-License-Identifier: GPL-3.0-or-later
#include <vtkCellArray.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <string>

#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/io/vtk_data_set.h"
#include "meshes/io/vtk_files.h"
#include "meshes/io/vtk_messages.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

void require_no_message(const std::string& path, const VtkMessages& messages) {
  const std::string message = messages.first();
  if (!message.empty()) throw InputError(path + ": VTK: " + message);
}

/// VTK does not look whether offsets, types and connectivity belong together.
void require_consistent(const std::string& path, vtkUnstructuredGrid& grid) {
  vtkUnsignedCharArray* types = grid.GetCellTypesArray();
  if (grid.GetNumberOfCells() == 0)
    throw InputError(path + ": the file has no cells; it holds no mesh or is truncated");
  if (!types || types->GetNumberOfTuples() != grid.GetNumberOfCells() ||
      !grid.GetCells()->IsValid())
    throw InputError(path +
                     ": the numbers of cells, cell types and cell nodes do not fit together; the "
                     "file is truncated or damaged");
}

/// VTK's copy of a file is gone when the mesh is made of its parts, and the text before VTK reads:
/// large meshes would need twice the memory.
MeshParts legacy_vtk_parts(const std::filesystem::path& path) {
  const std::string name = path.string();
  {
    const std::string content = read_whole_file(path);
    if (!content.starts_with("# vtk DataFile"))
      throw InputError(name +
                       ":1: the first line is not '# vtk DataFile Version ...'; this is not a "
                       "legacy VTK file");
    check_legacy_vtk_structure(path, content);
  }
  const VtkMessages messages;
  vtkNew<vtkGenericDataObjectReader> reader;
  reader->SetFileName(name.c_str());
  reader->ReadAllScalarsOn();
  reader->ReadAllFieldsOn();
  reader->Update();
  require_no_message(name, messages);
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(reader->GetOutput())) {
    require_consistent(name, *grid);
    return parts_of_data_set(name, *grid);
  }
  auto* polygons = vtkPolyData::SafeDownCast(reader->GetOutput());
  if (!polygons)
    throw InputError(name + ": the file holds no unstructured grid and no polygonal data");
  for (vtkCellArray* cells : {polygons->GetVerts(), polygons->GetLines(), polygons->GetPolys()})
    if (cells && !cells->IsValid())
      throw InputError(name + ": the numbers of cells and cell nodes do not fit together");
  polygons->BuildCells();
  return parts_of_data_set(name, *polygons);
}

MeshParts vtu_parts(const std::filesystem::path& path) {
  const std::string name = path.string();
  {
    const std::string content = read_whole_file(path);
    if (content.find("<VTKFile") == std::string::npos)
      throw InputError(name + ": the file has no element <VTKFile>; this is not a .vtu file");
    check_vtu_field_data(path, content);
  }
  const VtkMessages messages;
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  if (!reader->CanReadFile(name.c_str()))
    throw InputError(name + ": the file holds no unstructured grid in VTK's XML format");
  reader->SetFileName(name.c_str());
  reader->Update();
  require_no_message(name, messages);
  require_consistent(name, *reader->GetOutput());
  return parts_of_data_set(name, *reader->GetOutput());
}

}  // namespace

MeshFile read_legacy_vtk(const std::filesystem::path& path) {
  return assemble_mesh(path, legacy_vtk_parts(path));
}

MeshFile read_vtu(const std::filesystem::path& path) {
  return assemble_mesh(path, vtu_parts(path));
}

namespace {

MeshFormat vtk_format(const std::string& name, const std::string& description,
                      decltype(MeshFormat::read) read, decltype(MeshFormat::write) write) {
  return {.name = name,
          .extension = "." + name,
          .description = description,
          .holds_planar_meshes = true,
          .holds_volume_meshes = true,
          .holds_surface_meshes = true,
          .holds_polygons = true,
          .holds_fixed_nodes = true,
          .holds_physical_names = true,
          .holds_numbers = true,
          .read = read,
          .write = write};
}

const RegisteredFormat legacy(vtk_format("vtk", "legacy VTK, text or binary", read_legacy_vtk,
                                         write_legacy_vtk));
const RegisteredFormat xml(vtk_format("vtu", "VTK XML unstructured grid", read_vtu, write_vtu));

}  // namespace

}  // namespace smoothfem
