// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "meshes/tools/gmsh_session.h"
#include "meshes/tools/mesh_cells.h"

namespace smoothfem {

/// Algorithms for tetrahedra: those of Debian's Gmsh by its numbers, and Netgen's.
enum class TetrahedronAlgorithm { delaunay = 1, hxt = 10, netgen = -1 };

/// Meshes the volumes of a model with tetrahedra by Gmsh (on one thread; Delaunay, unless `build`
/// sets another algorithm). build: Gmsh calls that make the model and set all edge lengths; there
/// is no other source of edge lengths. name: for messages, for example "the piston". Throws
/// InputError with Gmsh's message if it fails.
VolumeCells mesh_with_tetrahedra(const std::string& name,
                                 const std::function<void(GmshSession&)>& build);

/// Sets the options of triangles and lengths that mesh_with_tetrahedra uses.
void use_frontal_surfaces(GmshSession& session);
void set_algorithm(GmshSession& session, TetrahedronAlgorithm algorithm);

/// Sets the length of all edges without another rule.
void set_edge_length(GmshSession& session, double length);

/// Gmsh swaps faces of tetrahedra whose radius ratio is below this; lower thresholds leave flatter
/// ones.
constexpr double usual_optimization_threshold = 0.3;

/// Fills the space between closed surfaces, the first of them around the others, with tetrahedra.
/// surfaces: rows of three nodes, in either direction. edge_length: of the longest edges inside;
/// lengths grow to it from the surfaces' edges. The result's first nodes are `points`, in their
/// order. name, errors: as above.
VolumeCells fill_with_tetrahedra(const std::string& name, const std::vector<Point<3>>& points,
                                 const std::vector<CompressedRows<NodeIndex>>& surfaces,
                                 double edge_length,
                                 double optimization_threshold = usual_optimization_threshold);

}  // namespace smoothfem
