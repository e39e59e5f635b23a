// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/grid/tria.h>

#include <array>
#include <memory>

#include "fem/ranks/ranks.h"
#include "smoothing/mesh/mesh.h"

// Includes deal.II's headers: for sources of this folder only.

namespace smoothfem {

/// Types of elements that a mesh of this dimension can be solved on.
template <int dim>
constexpr std::array element_types =
    dim == 2 ? std::array{ElementType::triangle, ElementType::quadrilateral}
             : std::array{ElementType::tetrahedron, ElementType::hexahedron};
/// Indices into that list, and into lists of associated data.
constexpr unsigned int simplex_index = 0, tensor_index = 1;

/// Makes a triangulation. mesh: on the root, with cells of these types; not used elsewhere. One
/// process: a triangulation with the mesh's own nodes and cells. Several: a part for each, of about
/// equal size; only the root ever has all of it. Each vertex' first coordinate is then the mesh's
/// number of the node. The material of a cell is its kind. Collective.
template <int dim>
std::unique_ptr<dealii::Triangulation<dim>> make_triangulation(const Mesh<dim>* mesh,
                                                               const Ranks& ranks);

}  // namespace smoothfem
