// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

class vtkUnstructuredGrid;

namespace smoothfem {

/// Returns a grid as a legacy .vtk file of version 4.2 in text. Each number has the fewest digits
/// that keep all its bits; those of VTK's writer have 11 digits.
std::string legacy_vtk_text(vtkUnstructuredGrid& grid);

}  // namespace smoothfem
