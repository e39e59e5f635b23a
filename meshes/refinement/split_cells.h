// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Splits every cell: triangles and quadrilaterals into 4, tetrahedra, prisms and hexahedra into 8,
/// pyramids into 6 pyramids and 4 tetrahedra. New nodes are means of the nodes of an edge, a
/// quadrilateral, or a hexahedron, so that sides keep their shape. The inner octahedron of a
/// tetrahedron is cut along its shortest diagonal. Parts inherit cell and facet tags with their
/// names; existing nodes keep their numbers. All cells must be valid; the parts of a hexahedron
/// that is valid at its corners may be invalid. Throws InputError for polygons with more than four
/// nodes.
template <int dim>
Mesh<dim> with_split_cells(const Mesh<dim>& mesh);

}  // namespace smoothfem
