// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// The mesh with every cell split: triangles and quadrilaterals into 4, tetrahedra, prisms and
/// hexahedra into 8, pyramids into 6 pyramids and 4 tetrahedra. New nodes are the means of the
/// nodes of an edge, of a quadrilateral face or cell, or of a hexahedron, so sides stay where they
/// are. Of the three ways to cut the inner octahedron of a tetrahedron the one along its shortest
/// diagonal is taken. Cell and facet tags and their names go on to the parts; the nodes that there
/// were keep their numbers. All cells have to be valid; children of a hexahedron that is valid at
/// its corners may be invalid. Throws InputError for polygons with more than four nodes.
template <int dim>
Mesh<dim> with_split_cells(const Mesh<dim>& mesh);

}  // namespace smoothfem
