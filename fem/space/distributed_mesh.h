// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/grid/tria.h>

#include <array>
#include <functional>
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

/// Makes a triangulation that `fill` fills, which only the root calls. One process: just that.
/// Several: a part for each, of about equal size; only the root ever has all of it. Each vertex'
/// first coordinate is then its number in the whole, and a cell's id as a coarse cell is its number
/// there. Collective.
template <int dim>
std::unique_ptr<dealii::Triangulation<dim>> distributed_triangulation(
    const std::function<void(dealii::Triangulation<dim>&)>& fill, const Ranks& ranks);

/// Makes a triangulation of the root's mesh, with cells of these types, in this way. Vertices are
/// nodes. The material of a cell is its kind. mesh: not used elsewhere. Collective.
template <int dim>
std::unique_ptr<dealii::Triangulation<dim>> make_triangulation(const Mesh<dim>* mesh,
                                                               const Ranks& ranks);

}  // namespace smoothfem
