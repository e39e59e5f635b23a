// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "meshes/io/mesh_assembly.h"

class vtkPointSet;

namespace smoothfem {

/// The mesh of a VTK data set, whose offsets, types and connectivity belong together: points, cells
/// and what the arrays `fixed`, `node_id`, `cell_id`, `physical_tag` and `physical_name` say.
/// Vertices and lines of several edges are left out. Wedges may have Gmsh's order of nodes: the one
/// counts that makes more volumes positive. Throws InputError that begins with the path for cells
/// of other types, points that are not there, and arrays of a wrong length.
MeshParts parts_of_data_set(const std::string& path, vtkPointSet& data);

}  // namespace smoothfem
