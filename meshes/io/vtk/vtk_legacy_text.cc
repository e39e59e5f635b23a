// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/io/vtk/vtk_legacy_text.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include <cstdio>
#include <limits>

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

void append_array(std::string& text, vtkDataArray& array) {
  const int n_components = array.GetNumberOfComponents();
  const vtkIdType n_rows = array.GetNumberOfTuples();
  text += encoded_vtk_name(array.GetName()) + " " + std::to_string(n_components) + " " +
          std::to_string(n_rows) + " ";
  switch (array.GetDataType()) {
    vtkTemplateMacro(
        text += type_name<VTK_TT>() + "\n";
        append_values(text, static_cast<VTK_TT*>(array.GetVoidPointer(0)), n_rows, n_components));
  }
}

void append_arrays(std::string& text, const std::string& head, vtkFieldData& arrays) {
  if (arrays.GetNumberOfArrays() == 0) return;
  text += head + "FIELD FieldData " + std::to_string(arrays.GetNumberOfArrays()) + "\n";
  for (int i = 0; i < arrays.GetNumberOfArrays(); ++i) append_array(text, *arrays.GetArray(i));
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
  append_arrays(text, "", *grid.GetFieldData());
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
