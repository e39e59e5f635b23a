// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "meshes/tools/gmsh_session.h"
#include "meshes/tools/mesh_cells.h"

namespace smoothfem {

/// Meshes the volumes of a model with tetrahedra by Gmsh (Delaunay, one thread). build: Gmsh calls
/// that make the model and say how long edges shall be; edge lengths come from nowhere else. name:
/// "the piston". Throws InputError with Gmsh's words if it cannot.
VolumeCells mesh_with_tetrahedra(const std::string& name,
                                 const std::function<void(GmshSession&)>& build);

/// A length for all edges that nothing else says the length of.
void set_edge_length(GmshSession& session, double length);

/// Gmsh swaps faces of tetrahedra whose radius ratio is below this; lower thresholds leave flatter
/// ones.
constexpr double usual_optimization_threshold = 0.3;

/// Fills the space between closed surfaces, the first of them around the others, with tetrahedra.
/// surfaces: rows of three nodes, in either direction. edge_length: of the longest edges inside;
/// from the surfaces' own edges it grows to this. The result's first nodes are `points`, in their
/// order. name, errors: as above.
VolumeCells fill_with_tetrahedra(const std::string& name, const std::vector<Point<3>>& points,
                                 const std::vector<CompressedRows<NodeIndex>>& surfaces,
                                 double edge_length,
                                 double optimization_threshold = usual_optimization_threshold);

}  // namespace smoothfem
