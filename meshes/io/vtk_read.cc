#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellTypes.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "meshes/io/line_reader.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/io/vtk_files.h"
#include "meshes/io/vtk_messages.h"
#include "smoothing/mesh/input_error.h"

namespace smoothfem {

namespace {

/// Collects the mesh of a VTK data set; every problem is thrown with the file's path in front.
class DataSetReader {
 public:
  DataSetReader(std::string path, vtkPointSet& data) : path_(std::move(path)), data_(data) {}

  MeshParts parts() {
    read_points();
    read_fixed();
    vtkDataArray* tags = cell_array("physical_tag");
    vtkNew<vtkIdList> nodes;
    std::vector<int> cell_tags;
    for (vtkIdType c = 0; c < data_.GetNumberOfCells(); ++c) {
      const int tag = tags ? static_cast<int>(tags->GetComponent(c, 0)) : 0;
      data_.GetCellPoints(c, nodes);
      if (add_cell(c, nodes)) cell_tags.push_back(tag);
      if (is_labelled_line(c, tag)) {
        parts_.labels.facets.append(indices(c, nodes));
        parts_.labels.facet_tags.push_back(tag);
      }
    }
    if (tags) parts_.labels.cell_tags = std::move(cell_tags);
    return std::move(parts_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(path_ + ": " + message);
  }

  void read_points() {
    const vtkIdType n = data_.GetNumberOfPoints();
    if (n == 0) fail("the file has no points");
    if (static_cast<std::size_t>(n) >= std::numeric_limits<NodeIndex>::max())
      fail("the mesh has more nodes than 32 bits can count");
    double first[3];
    data_.GetPoint(0, first);
    for (vtkIdType i = 0; i < n; ++i) {
      double xyz[3];
      data_.GetPoint(i, xyz);
      if (xyz[2] != first[2])
        fail("point " + std::to_string(i) + " has z = " + std::to_string(xyz[2]) +
             " and point 0 z = " + std::to_string(first[2]) +
             "; only planar meshes with constant z can be read");
      parts_.coordinates.emplace_back(xyz[0], xyz[1]);
    }
  }

  void read_fixed() {
    vtkDataArray* fixed = data_.GetPointData()->GetArray("fixed");
    if (!fixed) return;
    if (fixed->GetNumberOfTuples() != data_.GetNumberOfPoints())
      fail("the point array 'fixed' has " + std::to_string(fixed->GetNumberOfTuples()) +
           " values for " + std::to_string(data_.GetNumberOfPoints()) + " points");
    parts_.fixed.emplace();
    for (vtkIdType i = 0; i < fixed->GetNumberOfTuples(); ++i)
      parts_.fixed->push_back(fixed->GetComponent(i, 0) != 0.0);
  }

  vtkDataArray* cell_array(const char* name) const {
    vtkDataArray* array = data_.GetCellData()->GetArray(name);
    if (array && array->GetNumberOfTuples() != data_.GetNumberOfCells())
      fail(std::string("the cell array '") + name + "' has " +
           std::to_string(array->GetNumberOfTuples()) + " values for " +
           std::to_string(data_.GetNumberOfCells()) + " cells");
    return array;
  }

  bool is_labelled_line(vtkIdType cell, int tag) const {
    return tag != 0 && data_.GetCellType(cell) == VTK_LINE;
  }

  std::vector<NodeIndex> indices(vtkIdType cell, vtkIdList* nodes) const {
    std::vector<NodeIndex> row;
    for (vtkIdType k = 0; k < nodes->GetNumberOfIds(); ++k) {
      const vtkIdType node = nodes->GetId(k);
      if (node < 0 || node >= data_.GetNumberOfPoints())
        fail("cell " + std::to_string(cell) + " names point " + std::to_string(node) +
             ", but the file has only " + std::to_string(data_.GetNumberOfPoints()) + " points");
      row.push_back(static_cast<NodeIndex>(node));
    }
    return row;
  }

  /// False for cells that are not part of the mesh (points and lines).
  bool add_cell(vtkIdType cell, vtkIdList* nodes) {
    const int type = data_.GetCellType(cell);
    std::size_t n_expected = 0;
    switch (type) {
      case VTK_VERTEX:
      case VTK_POLY_VERTEX:
      case VTK_LINE:
      case VTK_POLY_LINE:
        return false;
      case VTK_TRIANGLE:
        n_expected = 3;
        break;
      case VTK_QUAD:
      case VTK_PIXEL:
        n_expected = 4;
        break;
      case VTK_POLYGON:
        break;
      default:
        fail("cell " + std::to_string(cell) + " has the VTK type " + std::to_string(type) + " (" +
             vtkCellTypes::GetClassNameFromTypeId(type) +
             "); only planar triangles, quadrilaterals and polygons can be read");
    }
    std::vector<NodeIndex> row = indices(cell, nodes);
    if (n_expected != 0 && row.size() != n_expected)
      fail("cell " + std::to_string(cell) + " has " + std::to_string(row.size()) +
           " nodes, but its type has " + std::to_string(n_expected));
    if (type == VTK_PIXEL) std::swap(row[2], row[3]);  // pixels list their nodes row by row
    parts_.cells.append(row);
    return true;
  }

  std::string path_;
  vtkPointSet& data_;
  MeshParts parts_;
};

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

}  // namespace

MeshFile read_legacy_vtk(const std::filesystem::path& path) {
  const std::string content = read_whole_file(path);
  const std::string name = path.string();
  if (!content.starts_with("# vtk DataFile"))
    throw InputError(name +
                     ":1: the first line is not '# vtk DataFile Version ...'; this is not a "
                     "legacy VTK file");
  check_legacy_vtk_cells(path, content);
  const VtkMessages messages;
  vtkNew<vtkGenericDataObjectReader> reader;
  reader->SetFileName(name.c_str());
  reader->ReadAllScalarsOn();
  reader->ReadAllFieldsOn();
  reader->Update();
  require_no_message(name, messages);
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(reader->GetOutput())) {
    require_consistent(name, *grid);
    return assemble_mesh(path, DataSetReader(name, *grid).parts());
  }
  auto* polygons = vtkPolyData::SafeDownCast(reader->GetOutput());
  if (!polygons)
    throw InputError(name + ": the file holds no unstructured grid and no polygonal data");
  for (vtkCellArray* cells : {polygons->GetVerts(), polygons->GetLines(), polygons->GetPolys()})
    if (cells && !cells->IsValid())
      throw InputError(name + ": the numbers of cells and cell nodes do not fit together");
  polygons->BuildCells();
  return assemble_mesh(path, DataSetReader(name, *polygons).parts());
}

MeshFile read_vtu(const std::filesystem::path& path) {
  const std::string content = read_whole_file(path);
  const std::string name = path.string();
  if (content.find("<VTKFile") == std::string::npos)
    throw InputError(name + ": the file has no element <VTKFile>; this is not a .vtu file");
  const VtkMessages messages;
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  if (!reader->CanReadFile(name.c_str()))
    throw InputError(name + ": the file holds no unstructured grid in VTK's XML format");
  reader->SetFileName(name.c_str());
  reader->Update();
  require_no_message(name, messages);
  require_consistent(name, *reader->GetOutput());
  return assemble_mesh(path, DataSetReader(name, *reader->GetOutput()).parts());
}

}  // namespace smoothfem
