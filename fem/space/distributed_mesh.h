// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/grid/tria.h>

#include <array>
#include <memory>

#include "fem/ranks/ranks.h"
#include "smoothing/mesh/mesh.h"

// With deal.II's headers: for sources of this folder only.

namespace smoothfem {

/// The types of element that a mesh of this dimension can be solved on.
template <int dim>
constexpr std::array element_types =
    dim == 2 ? std::array{ElementType::triangle, ElementType::quadrilateral}
             : std::array{ElementType::tetrahedron, ElementType::hexahedron};
/// Indices into that list, and into lists of what belongs to them.
constexpr unsigned int simplex_index = 0, tensor_index = 1;

/// mesh: on the root, of these types; not looked at elsewhere. One process: a triangulation with
/// the mesh's own nodes and cells. Several: a part for each, of about the same size, of which the
/// root alone has ever seen the whole; in it each vertex' first coordinate is the mesh's number of
/// the node. Collective.
template <int dim>
std::unique_ptr<dealii::Triangulation<dim>> make_triangulation(const Mesh<dim>* mesh,
                                                               const Ranks& ranks);

}  // namespace smoothfem
