// SPDX-License-Identifier: GPL-3.0-or-later
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTypeInt64Array.h>
#include <vtkTypeTraits.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <streambuf>
#include <string>

#include "meshes/io/all_elements.h"
#include "meshes/io/atomic_file.h"
#include "meshes/io/error_latching_filebuf.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/io/node_order.h"
#include "meshes/io/vtk/vtk_files.h"
#include "meshes/io/vtk/vtk_legacy_text.h"
#include "meshes/io/vtk/vtk_messages.h"
#include "meshes/io/vtk/vtk_second_order.h"
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

/// What a grid has of a mesh.
struct GridSource {
  std::size_t n_nodes;
  std::function<Point<3>(NodeIndex)> point;
  std::function<bool(NodeIndex)> stays;
  AllElements elements;
  const MeshLabels& labels;
};

GridSource source_of(const MeshView& mesh) {
  return {mesh.n_nodes(), [&](NodeIndex i) { return mesh.point(i); },
          [&](NodeIndex i) { return mesh.topology().reasons_to_stay(i) != 0; }, AllElements(mesh),
          mesh.topology().labels()};
}

GridSource source_of(const PlainMesh& mesh) {
  return {mesh.points.size(), [&](NodeIndex i) { return mesh.points[i]; },
          [&](NodeIndex i) -> bool { return mesh.fixed[i]; },
          AllElements(mesh.dimension, mesh.cells, mesh.labels), mesh.labels};
}

void set_points(const GridSource& mesh, vtkUnstructuredGrid& grid) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.n_nodes));
  for (NodeIndex i = 0; i < mesh.n_nodes; ++i) points->SetPoint(i, mesh.point(i).data());
  grid.SetPoints(points);
}

const FormatElement* vtk_type(int dimension, std::size_t n_corners, std::size_t n_midside) {
  return find_type(vtk_quadratic_types, dimension, n_corners, n_midside);
}

int vtk_type_of(int dimension, std::size_t n_nodes) {
  return dimension == 0   ? VTK_VERTEX
         : dimension == 1 ? VTK_LINE
                          : vtk_type(element_type(dimension, n_nodes));
}

/// Fills VTK's arrays as wholes: its calls for single cells take much longer.
void set_cells(const AllElements& elements, const std::vector<std::uint32_t>& order,
               vtkUnstructuredGrid& grid) {
  const auto n = static_cast<vtkIdType>(elements.size());
  vtkNew<vtkTypeInt64Array> offsets, nodes;
  vtkNew<vtkUnsignedCharArray> types;
  offsets->SetNumberOfValues(n + 1);
  types->SetNumberOfValues(n);
  vtkIdType n_entries = 0;
  for (vtkIdType k = 0; k < n; ++k) {
    offsets->SetValue(k, n_entries);
    n_entries += static_cast<vtkIdType>(elements.row(order[static_cast<std::size_t>(k)]).size());
  }
  offsets->SetValue(n, n_entries);
  nodes->SetNumberOfValues(n_entries);
  vtkTypeInt64* to = nodes->GetPointer(0);
  for (vtkIdType k = 0; k < n; ++k) {
    const std::uint32_t e = order[static_cast<std::size_t>(k)];
    const auto corners = elements.nodes(e), midside = elements.midside(e);
    const int dimension = elements.dimension(e);
    const FormatElement* second_order =
        midside.empty() ? nullptr : vtk_type(dimension, corners.size(), midside.size());
    const auto row = second_order ? elements.row(e, &second_order->order) : corners;
    const int type = second_order ? second_order->number : vtk_type_of(dimension, corners.size());
    types->SetValue(k, static_cast<unsigned char>(type));
    for (std::size_t i = 0; i < row.size(); ++i) *to++ = row[type == VTK_WEDGE ? vtk_wedge[i] : i];
  }
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, nodes);
  grid.SetCells(types, cells);
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

/// Returns a field's values at all elements; those below the cells have the value of a cell that
/// has all their nodes, and 0 if there is none: VTK's reader of text stops at "nan".
std::vector<double> with_other_elements(const Topology& topology, const AllElements& elements,
                                        std::vector<double> values) {
  for (std::size_t e = elements.n_cells(); e < elements.size(); ++e) {
    const CellIndex cell = cell_of_facet(topology, elements.nodes(e));
    values.push_back(cell < topology.n_cells() ? values[cell] : 0.0);
  }
  return values;
}

/// Adds a field of the file with its type. order: of its rows; empty: as they are.
void add_field(vtkFieldData& attributes, const MeshField& field,
               const std::vector<std::uint32_t>& order) {
  with_number_type(field.type, [&]<class T>() {
    vtkSmartPointer<vtkDataArray> array;
    array.TakeReference(vtkDataArray::CreateDataArray(vtkTypeTraits<T>::VTKTypeID()));
    std::string name = field.name;
    for (int k = 2; attributes.GetAbstractArray(name.c_str()); ++k)
      name = field.name + "_" + std::to_string(k);
    array->SetName(name.c_str());
    const std::size_t n = field.n_components, n_rows = field.n_rows();
    array->SetNumberOfComponents(static_cast<int>(n));
    array->SetNumberOfTuples(static_cast<vtkIdType>(n_rows));
    auto* to = static_cast<T*>(array->GetVoidPointer(0));
    std::visit(
        [&](const auto& values) {
          for (std::size_t i = 0; i < n_rows; ++i)
            for (std::size_t k = 0; k < n; ++k)
              *to++ = static_cast<T>(values[(order.empty() ? i : order[i]) * n + k]);
        },
        field.values);
    attributes.AddArray(array);
  });
}

void add_labels(const MeshLabels& labels, const AllElements& elements,
                const std::vector<std::uint32_t>& order, vtkUnstructuredGrid& grid) {
  const bool has_tag_field = labels.content && !labels.content->tag_field.empty();
  const auto has_value = [&](auto value_of) {
    for (std::size_t e = 0; e < elements.size(); ++e)
      if (value_of(e) != 0) return true;
    return false;
  };
  const auto values = [&]<class T>(T, auto value_of) {
    std::vector<T> result;
    for (const std::uint32_t e : order) result.push_back(static_cast<T>(value_of(e)));
    return result;
  };
  const auto tag = [&](std::size_t e) { return elements.tag(e); };
  if (!has_tag_field && (!labels.cell_tags.empty() || has_value(tag)))
    add_array<vtkIntArray>(*grid.GetCellData(), "physical_tag", values(int{}, tag));
  if (!labels.cell_ids.empty())
    add_array<vtkTypeInt64Array>(
        *grid.GetCellData(), "cell_id",
        values(std::int64_t{}, [&](std::size_t e) { return elements.id(e); }));
  if (!labels.node_ids.empty())
    add_array<vtkTypeInt64Array>(*grid.GetPointData(), "node_id", labels.node_ids);
  if (labels.names.empty()) return;
  // Not an array of strings: VTK crashes where such arrays are damaged.
  std::string lines;
  for (const auto& [key, name] : labels.names) lines += physical_name_line(key, name) + "\n";
  add_array<vtkUnsignedCharArray>(*grid.GetFieldData(), "physical_name", lines);
}

void add_content(const FileContent& content, const MeshFields& fields,
                 const std::vector<std::uint32_t>& order, vtkUnstructuredGrid& grid) {
  for (const MeshField& field : content.node_fields)
    if (!fields.point.contains(field.name)) add_field(*grid.GetPointData(), field, {});
  for (const MeshField& field : content.element_fields)
    if (!fields.cell.contains(field.name)) add_field(*grid.GetCellData(), field, order);
  for (const MeshField& field : content.file_fields) add_field(*grid.GetFieldData(), field, {});
}

enum class VtkFormat { legacy, xml };

/// Returns the array in the type that VTK wants for a role; null if it cannot have the role. In
/// legacy files VTK's type of indices has 32 bits, and scalars of bytes would become colours.
vtkSmartPointer<vtkDataArray> array_for_role(int role, vtkDataArray* array, VtkFormat format) {
  const bool is_legacy = format == VtkFormat::legacy;
  if (!array || (is_legacy && role == vtkDataSetAttributes::SCALARS &&
                 array->GetDataType() == VTK_UNSIGNED_CHAR))
    return nullptr;
  if (role != vtkDataSetAttributes::GLOBALIDS || array->GetNumberOfComponents() != 1) return array;
  const double* range = array->GetRange();
  const bool is_integer = array->GetDataType() != VTK_FLOAT && array->GetDataType() != VTK_DOUBLE;
  if (!is_integer || range[0] < INT32_MIN || range[1] > INT32_MAX)
    return is_legacy ? nullptr : array;
  const auto ids = vtkSmartPointer<vtkIdTypeArray>::New();
  ids->DeepCopy(array);
  return ids;
}

/// Gives arrays the roles that they have in the file.
void set_roles(const std::map<std::string, std::string>& roles, VtkFormat format,
               vtkDataSetAttributes& arrays) {
  const VtkMessages silence;  // an array may not have the size that its role asks for
  for (int role = 0; role < vtkDataSetAttributes::NUM_ATTRIBUTES; ++role) {
    const auto name = roles.find(vtkDataSetAttributes::GetAttributeTypeAsString(role));
    if (name == roles.end()) continue;
    const auto array = array_for_role(role, arrays.GetArray(name->second.c_str()), format);
    if (!array) continue;
    arrays.AddArray(array);  // in the place of that of the same name
    arrays.SetActiveAttribute(name->second.c_str(), role);
  }
}

/// topology: for the values of facets; null if there are no cell fields.
vtkSmartPointer<vtkUnstructuredGrid> grid_of(const GridSource& mesh, const MeshFields& fields,
                                             VtkFormat format, const Topology* topology) {
  const AllElements& elements = mesh.elements;
  const FileContent* content = mesh.labels.content.get();
  const auto order = elements.in_file_order(content);
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  set_points(mesh, *grid);
  set_cells(elements, order, *grid);
  std::vector<int> fixed(mesh.n_nodes);
  for (NodeIndex i = 0; i < mesh.n_nodes; ++i) fixed[i] = mesh.stays(i) ? 1 : 0;
  add_array<vtkIntArray>(*grid->GetPointData(), "fixed", fixed);
  add_labels(mesh.labels, elements, order, *grid);
  if (content) add_content(*content, fields, order, *grid);
  for (const auto& [name, values] : fields.point)
    add_array<vtkDoubleArray>(*grid->GetPointData(), name, values);
  for (const auto& [name, of_cells] : fields.cell) {
    const auto canonical = with_other_elements(*topology, elements, of_cells);
    std::vector<double> values;
    for (const std::uint32_t e : order) values.push_back(canonical[e]);
    add_array<vtkDoubleArray>(*grid->GetCellData(), name, values);
  }
  if (content) {
    set_roles(content->node_roles, format, *grid->GetPointData());
    set_roles(content->element_roles, format, *grid->GetCellData());
  }
  return grid;
}

vtkSmartPointer<vtkUnstructuredGrid> grid_of(const MeshView& mesh, const MeshFields& fields,
                                             VtkFormat format) {
  return grid_of(source_of(mesh), fields, format, &mesh.topology());
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

namespace {

/// As the user wishes, otherwise as in the file that the mesh comes from.
bool writes_binary(const FileContent* content, const MeshWriteOptions& options,
                   std::string_view format) {
  return options.binary.value_or(!content || content->format != format || content->is_binary);
}

}  // namespace

namespace {

void require_vtk_cells(const std::filesystem::path& path, const MeshView& mesh) {
  require_held(path, mesh, "VTK", ".msh",
               [](int dimension, std::size_t corners, std::size_t midside) {
                 return vtk_type(dimension, corners, midside) != nullptr;
               });
}

}  // namespace

/// Writes to memory first: VTK does not notice every failed write; write_atomically does.
void write_legacy_vtk(const std::filesystem::path& path, const MeshView& mesh,
                      const MeshFields& fields, const MeshWriteOptions& options) {
  require_vtk_cells(path, mesh);
  if (!writes_binary(mesh.content(), options, "vtk"))
    return write_atomically(path, legacy_vtk_text(*grid_of(mesh, fields, VtkFormat::legacy)));
  vtkNew<vtkUnstructuredGridWriter> writer;
  writer->SetFileVersion(vtkUnstructuredGridWriter::VTK_LEGACY_READER_VERSION_4_2);
  writer->SetFileTypeToBinary();
  writer->SetHeader("smoothfem mesh");
  writer->SetInputData(grid_of(mesh, fields, VtkFormat::legacy));
  writer->WriteToOutputStringOn();
  run(*writer, path);
  write_atomically(path, writer->GetOutputStdString());
}

namespace {

void write_vtu(const std::filesystem::path& path, vtkUnstructuredGrid& grid, bool is_binary) {
  vtkNew<StreamingWriter> writer;
  if (is_binary)
    writer->SetDataModeToBinary();
  else
    writer->SetDataModeToAscii();
  writer->SetHeaderTypeToUInt64();
  writer->SetCompressorTypeToNone();
  escape_names(*grid.GetPointData());
  escape_names(*grid.GetCellData());
  writer->SetInputData(&grid);
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    ErrorLatchingFilebuf file(temporary);
    writer->set_buffer(file);
    run(*writer, path);
    file.finish();
  });
}

}  // namespace

void write_vtu(const std::filesystem::path& path, const MeshView& mesh, const MeshFields& fields,
               const MeshWriteOptions& options) {
  require_vtk_cells(path, mesh);
  write_vtu(path, *grid_of(mesh, fields, VtkFormat::xml),
            writes_binary(mesh.content(), options, "vtu"));
}

void write_vtu(const std::filesystem::path& path, const PlainMesh& mesh) {
  write_vtu(path, *grid_of(source_of(mesh), {}, VtkFormat::xml, nullptr),
            writes_binary(mesh.labels.content.get(), {}, "vtu"));
}

}  // namespace smoothfem
