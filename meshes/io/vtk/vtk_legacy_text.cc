// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtk/vtk_legacy_text.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "meshes/io/vtk/vtk_grid.h"
#include "smoothing/base/text.h"

namespace smoothfem {

namespace {

/// As VTK does: characters that are no letters in ASCII, blanks, quotes and percent signs are
/// codes.
std::string encoded_vtk_name(const std::string& name) {
  std::string encoded;
  for (const char c : name) {
    const auto code = static_cast<unsigned char>(c);
    if (code >= 33 && code <= 126 && c != '"' && c != '%') {
      encoded += c;
      continue;
    }
    char digits[4];
    std::snprintf(digits, sizeof digits, "%%%02X", code);
    encoded += digits;
  }
  return encoded;
}

template <class T>
std::string type_name() {
  if constexpr (!std::numeric_limits<T>::is_integer)
    return sizeof(T) == sizeof(float) ? "float" : "double";
  const std::string sign = std::numeric_limits<T>::is_signed ? "" : "unsigned_";
  if constexpr (sizeof(T) == 1) return sign + "char";
  if constexpr (sizeof(T) == 2) return sign + "short";
  if constexpr (sizeof(T) == 4) return sign + "int";
  return std::numeric_limits<T>::is_signed ? "long" : "unsigned_long";  // as VTK writes here
}

template <class T>
void append_values(std::string& text, const T* values, vtkIdType n_rows, int n_components) {
  for (vtkIdType i = 0; i < n_rows; ++i)
    for (int k = 0; k < n_components; ++k) {
      append_number(text, *values++);
      text += k + 1 < n_components ? ' ' : '\n';
    }
}

std::string type_name_of(vtkDataArray& array) {
  if (array.GetDataType() == VTK_ID_TYPE) return "vtkIdType";
  switch (array.GetDataType()) { vtkTemplateMacro(return type_name<VTK_TT>()); }
  return {};
}

void append_values_of(std::string& text, vtkDataArray& array) {
  switch (array.GetDataType()) {
    vtkTemplateMacro(append_values(text, static_cast<VTK_TT*>(array.GetVoidPointer(0)),
                                   array.GetNumberOfTuples(), array.GetNumberOfComponents()));
  }
}

void append_field(std::string& text, const std::vector<vtkDataArray*>& arrays) {
  if (arrays.empty()) return;
  text += "FIELD FieldData " + std::to_string(arrays.size()) + "\n";
  for (vtkDataArray* array : arrays) {
    text += encoded_vtk_name(array->GetName()) + " " +
            std::to_string(array->GetNumberOfComponents()) + " " +
            std::to_string(array->GetNumberOfTuples()) + " " + type_name_of(*array) + "\n";
    append_values_of(text, *array);
  }
}

std::vector<vtkDataArray*> arrays_of(vtkFieldData& arrays) {
  std::vector<vtkDataArray*> result;
  for (int i = 0; i < arrays.GetNumberOfArrays(); ++i) result.push_back(arrays.GetArray(i));
  return result;
}

/// Appends an array with a role as a section of its own.
void append_role(std::string& text, const VtkRole& role, vtkDataArray& array) {
  std::string keyword(role.keyword);
  for (char& c : keyword) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  const std::string n = " " + std::to_string(array.GetNumberOfComponents());
  const bool is_scalar = role.name == "Scalars", states_n = role.n_components == 0;
  text += keyword + " " + encoded_vtk_name(array.GetName()) + (states_n && !is_scalar ? n : "") +
          " " + type_name_of(array) + (is_scalar && n != " 1" ? n : "") + "\n" +
          (is_scalar ? "LOOKUP_TABLE default\n" : "");
  append_values_of(text, array);
}

/// Appends the arrays with a role, and all others as a field, as VTK does.
void append_arrays(std::string& text, const std::string& head, vtkDataSetAttributes& attributes) {
  auto others = arrays_of(attributes);
  if (others.empty()) return;
  text += head;
  for (const VtkRole& role : vtk_roles)
    for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type) {
      auto* array = attributes.GetAttribute(type);
      if (!array || role.name != vtkDataSetAttributes::GetAttributeTypeAsString(type)) continue;
      const auto n = static_cast<std::uint64_t>(array->GetNumberOfComponents());
      if (role.n_components != 0 && role.n_components != n) continue;
      append_role(text, role, *array);
      std::erase(others, array);
    }
  append_field(text, others);
}

void append_cells(std::string& text, vtkUnstructuredGrid& grid) {
  const vtkIdType n = grid.GetNumberOfCells();
  std::string rows, types;
  std::size_t n_entries = 0;
  vtkNew<vtkIdList> nodes;
  for (vtkIdType c = 0; c < n; ++c) {
    grid.GetCellPoints(c, nodes);
    append_number(rows, nodes->GetNumberOfIds());
    for (vtkIdType k = 0; k < nodes->GetNumberOfIds(); ++k) {
      rows += ' ';
      append_number(rows, nodes->GetId(k));
    }
    rows += '\n';
    n_entries += 1 + static_cast<std::size_t>(nodes->GetNumberOfIds());
    append_number(types, grid.GetCellType(c));
    types += '\n';
  }
  const std::string count = std::to_string(n);
  text += "CELLS " + count + " " + std::to_string(n_entries) + "\n" + rows;
  text += "CELL_TYPES " + count + "\n" + types;
}

}  // namespace

std::string legacy_vtk_text(vtkUnstructuredGrid& grid) {
  std::string text =
      "# vtk DataFile Version 4.2\nsmoothfem mesh\nASCII\nDATASET UNSTRUCTURED_GRID\n";
  append_field(text, arrays_of(*grid.GetFieldData()));
  const vtkIdType n_points = grid.GetNumberOfPoints();
  text += "POINTS " + std::to_string(n_points) + " double\n";
  append_values(text, static_cast<double*>(grid.GetPoints()->GetVoidPointer(0)), n_points, 3);
  append_cells(text, grid);
  append_arrays(text, "CELL_DATA " + std::to_string(grid.GetNumberOfCells()) + "\n",
                *grid.GetCellData());
  append_arrays(text, "POINT_DATA " + std::to_string(n_points) + "\n", *grid.GetPointData());
  return text;
}

}  // namespace smoothfem
