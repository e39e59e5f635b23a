// SPDX-License-Identifier: GPL-3.0-or-later
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <limits>
#include <streambuf>
#include <string>

#include "meshes/io/atomic_file.h"
#include "meshes/io/error_latching_filebuf.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/io/node_order.h"
#include "meshes/io/vtk/vtk_files.h"
#include "meshes/io/vtk/vtk_messages.h"
#include "meshes/io/vtk/xml_tags.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

int vtk_type(ElementType type) {
  switch (type) {
    case ElementType::triangle:
      return VTK_TRIANGLE;
    case ElementType::quadrilateral:
      return VTK_QUAD;
    case ElementType::polygon:
      return VTK_POLYGON;
    case ElementType::tetrahedron:
      return VTK_TETRA;
    case ElementType::pyramid:
      return VTK_PYRAMID;
    case ElementType::prism:
      return VTK_WEDGE;
    case ElementType::hexahedron:
      return VTK_HEXAHEDRON;
  }
  return VTK_EMPTY_CELL;
}

namespace {

template <class Array, class Values>
void add_array(vtkFieldData& attributes, const std::string& name, const Values& values) {
  vtkNew<Array> array;
  array->SetName(name.c_str());
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    array->SetValue(static_cast<vtkIdType>(i), values[i]);
  attributes.AddArray(array);
}

void set_points(const MeshView& mesh, vtkUnstructuredGrid& grid) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.n_nodes()));
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) points->SetPoint(i, mesh.point(i).data());
  grid.SetPoints(points);
}

void insert_cell(vtkUnstructuredGrid& grid, int type, std::span<const NodeIndex> nodes) {
  std::array<vtkIdType, 8> few;
  std::vector<vtkIdType> many;
  vtkIdType* row = few.data();
  if (nodes.size() > few.size()) {
    many.resize(nodes.size());
    row = many.data();
  }
  std::copy(nodes.begin(), nodes.end(), row);
  if (type == VTK_WEDGE) {
    for (std::size_t k = 0; k < nodes.size(); ++k) row[k] = nodes[vtk_wedge[k]];
  }
  grid.InsertNextCell(type, static_cast<vtkIdType>(nodes.size()), row);
}

void set_cells(const Topology& topology, vtkUnstructuredGrid& grid) {
  const auto& facets = topology.labels().facets;
  const std::size_t n_cells = topology.n_cells() + facets.size(),
                    n_entries = topology.cells().n_entries() + facets.n_entries();
  grid.AllocateExact(static_cast<vtkIdType>(n_cells), static_cast<vtkIdType>(n_entries));
  for (CellIndex c = 0; c < topology.n_cells(); ++c)
    insert_cell(grid, vtk_type(topology.cell_type(c)), topology.cell_nodes(c));
  for (std::size_t f = 0; f < facets.size(); ++f)
    insert_cell(grid,
                topology.dimension() == 2 ? VTK_LINE : vtk_type(element_type(2, facets[f].size())),
                facets[f]);
}

/// Returns the first cell that has all nodes of a facet; n_cells if there is no such cell.
CellIndex cell_of_facet(const Topology& topology, std::span<const NodeIndex> facet) {
  for (const CellIndex c : topology.node_cells(facet[0])) {
    const auto nodes = topology.cell_nodes(c);
    if (std::all_of(facet.begin(), facet.end(), [&](NodeIndex node) {
          return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
        }))
      return c;
  }
  return static_cast<CellIndex>(topology.n_cells());
}

/// Returns a field's values at the cells, followed by those at the labelled facets.
std::vector<double> with_facets(const Topology& topology, std::vector<double> values) {
  const auto& facets = topology.labels().facets;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const CellIndex cell = cell_of_facet(topology, facets[f]);
    values.push_back(cell < topology.n_cells() ? values[cell]
                                               : std::numeric_limits<double>::quiet_NaN());
  }
  return values;
}

void add_labels(const MeshLabels& labels, std::size_t n_cells, vtkUnstructuredGrid& grid) {
  const std::size_t n_facets = labels.facets.size();
  if (!labels.cell_tags.empty() || n_facets > 0) {
    std::vector<int> tags = labels.cell_tags;
    tags.resize(n_cells, 0);
    tags.insert(tags.end(), labels.facet_tags.begin(), labels.facet_tags.end());
    add_array<vtkIntArray>(*grid.GetCellData(), "physical_tag", tags);
  }
  if (!labels.cell_ids.empty()) {
    auto ids = labels.cell_ids;
    ids.resize(n_cells + n_facets, 0);
    add_array<vtkTypeInt64Array>(*grid.GetCellData(), "cell_id", ids);
  }
  if (!labels.node_ids.empty())
    add_array<vtkTypeInt64Array>(*grid.GetPointData(), "node_id", labels.node_ids);
  if (labels.names.empty()) return;
  // Not an array of strings: VTK crashes where such arrays are damaged.
  std::string lines;
  for (const auto& [key, name] : labels.names) lines += physical_name_line(key, name) + "\n";
  add_array<vtkUnsignedCharArray>(*grid.GetFieldData(), "physical_name", lines);
}

vtkSmartPointer<vtkUnstructuredGrid> grid_of(const MeshView& mesh, const MeshFields& fields) {
  const Topology& topology = mesh.topology();
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  set_points(mesh, *grid);
  set_cells(topology, *grid);
  std::vector<int> fixed(mesh.n_nodes());
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) fixed[i] = topology.is_fixed(i) ? 1 : 0;
  add_array<vtkIntArray>(*grid->GetPointData(), "fixed", fixed);
  add_labels(topology.labels(), mesh.n_cells(), *grid);
  for (const auto& [name, values] : fields.point)
    add_array<vtkDoubleArray>(*grid->GetPointData(), name, values);
  for (const auto& [name, values] : fields.cell)
    add_array<vtkDoubleArray>(*grid->GetCellData(), name, with_facets(topology, values));
  return grid;
}

template <class Writer>
void run(Writer& writer, const std::filesystem::path& path) {
  const VtkMessages messages;
  if (writer.Write() != 1 || messages.any())
    throw InputError("cannot write " + path.string() + ": VTK's writer does not take the mesh");
}

/// VTK's writer into a buffer of this program; as a string it would hold the file twice.
class StreamingWriter final : public vtkXMLUnstructuredGridWriter {
 public:
  static StreamingWriter* New();
  vtkTypeMacro(StreamingWriter, vtkXMLUnstructuredGridWriter);

  void set_buffer(std::streambuf& buffer) {
    buffer_ = &buffer;
    WriteToOutputStringOn();  // no file of its own
  }

 protected:
  int StartFile() override {
    Stream->rdbuf(buffer_);
    return vtkXMLUnstructuredGridWriter::StartFile();
  }

 private:
  std::streambuf* buffer_ = nullptr;
};

vtkStandardNewMacro(StreamingWriter);

}  // namespace

namespace {

/// VTK writes names as they are.
void escape_names(vtkFieldData& attributes) {
  for (int i = 0; i < attributes.GetNumberOfArrays(); ++i) {
    vtkAbstractArray& array = *attributes.GetAbstractArray(i);
    array.SetName(escaped_for_xml(array.GetName()).c_str());
  }
}

}  // namespace

/// Writes to memory first: VTK does not notice every failed write; write_atomically does.
void write_legacy_vtk(const std::filesystem::path& path, const MeshView& mesh,
                      const MeshFields& fields, const MeshWriteOptions&) {
  vtkNew<vtkUnstructuredGridWriter> writer;
  writer->SetFileVersion(vtkUnstructuredGridWriter::VTK_LEGACY_READER_VERSION_4_2);
  writer->SetFileTypeToBinary();
  writer->SetHeader("smoothfem mesh");
  writer->SetInputData(grid_of(mesh, fields));
  writer->WriteToOutputStringOn();
  run(*writer, path);
  write_atomically(path, writer->GetOutputStdString());
}

void write_vtu(const std::filesystem::path& path, const MeshView& mesh, const MeshFields& fields,
               const MeshWriteOptions&) {
  vtkNew<StreamingWriter> writer;
  writer->SetDataModeToBinary();
  writer->SetHeaderTypeToUInt64();
  writer->SetCompressorTypeToNone();
  const auto grid = grid_of(mesh, fields);
  escape_names(*grid->GetPointData());
  escape_names(*grid->GetCellData());
  writer->SetInputData(grid);
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    ErrorLatchingFilebuf file(temporary);
    writer->set_buffer(file);
    run(*writer, path);
    file.finish();
  });
}

}  // namespace smoothfem
