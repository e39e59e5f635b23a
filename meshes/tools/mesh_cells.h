// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Nodes and cells of a mesh under construction; the rows of cells have the order that Topology
/// requires.
template <int dim>
struct MeshCells {
  std::vector<Point<dim>> coordinates;
  CompressedRows<NodeIndex> cells;
};
using PlanarCells = MeshCells<2>;
using VolumeCells = MeshCells<3>;

/// Makes the mesh, with fixed boundary nodes. name: for messages, for example "generated flange".
/// Throws InputError with that name if a cell is invalid.
template <int dim>
Mesh<dim> mesh_of(MeshCells<dim> cells, const std::string& name);

/// Returns the nodes and cells of a mesh, without labels and fixed nodes.
template <int dim>
MeshCells<dim> cells_of(const Mesh<dim>& mesh) {
  return {{mesh.coordinates().begin(), mesh.coordinates().end()}, mesh.topology().cells()};
}

/// Throws InputError that names the domain, unless 1 <= edge_scale <= most.
void require_edge_scale(const std::string& domain, double edge_scale, int most);

}  // namespace smoothfem
