// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <memory>
#include <vector>

#include "fem/elements/reference_element.h"
#include "fem/ranks/ranks.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Rows compressed, columns ascending.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// The cells of one element that a process works on; arrays run over the cells first.
struct ElementCells {
  ReferenceElement element;
  std::size_t n_own = 0;  ///< these come first; the others belong to other ranks, but touch
                          ///< equations of this one
  std::vector<NodeIndex> vertices;     ///< local nodes in the element's order
  std::vector<std::uint32_t> dofs;     ///< local dofs in the element's order
  std::vector<std::uint32_t> entries;  ///< n_dofs x n_dofs each: where in the values of the
                                       ///< pattern; FiniteElementSpace::absent for rows of other
                                       ///< ranks and for boundary dofs

  std::size_t n_cells() const { return vertices.size() / element.n_vertices; }
};

/// The facets of one element on which natural conditions hold; arrays run over the facets first.
struct NaturalFacets {
  FacetElement element{};
  std::vector<NodeIndex> vertices{};  ///< local nodes in the element's order, seen from outside
  std::vector<std::uint32_t> dofs{};  ///< local dofs in the element's order
};

/// Everything about continuous Lagrange elements of degree 1 or 2 on a mesh that does not depend on
/// coordinates: made once, used for every mesh that smoothing produces. Each rank holds the
/// equations of its own dofs and all cells that contribute to them. Dofs are numbered locally: the
/// free ones of this rank's equations, free ones of other ranks in these equations, boundary dofs.
/// On parts of the boundary with natural conditions dofs are free.
template <int dim>
struct FiniteElementSpace {
  static constexpr std::uint32_t absent = UINT32_MAX;

  int degree = 0;
  Ranks ranks;
  std::size_t n_dofs = 0;  ///< of the whole mesh
  std::size_t n_free = 0;  ///< of the whole mesh: dofs that are not on the boundary
  std::size_t n_own = 0, n_columns = 0, n_local = 0;  ///< where the three kinds of local dofs end
  std::size_t n_own_boundary = 0;  ///< boundary dofs of this rank: the first of their kind

  std::vector<ElementCells> groups;
  std::vector<NaturalFacets> natural_facets;  ///< at least those that equations of this rank have
  /// Local nodes whose mean is a dof's position: a node, or the ends of an edge, the corners of a
  /// face or of a cell.
  CompressedRows<NodeIndex> dof_nodes;
  std::vector<NodeIndex> nodes;  ///< the mesh's node of each local node
  std::vector<NodeIndex>
      nodes_of_ranks;  ///< on the root: `nodes` of all ranks, one after the other
  std::vector<std::uint32_t> vertex_dof;  ///< the dof at each local node; absent at unused nodes

  SparseMatrix pattern;                     ///< of this rank's equations: n_own x n_columns
  std::vector<std::size_t> column_numbers;  ///< number of each column among all free dofs
  Halo halo;                                ///< for vectors of n_columns entries

  /// coordinates: of the mesh, needed on the root only. Returns those of the local nodes.
  /// Collective.
  std::vector<Point<dim>> local_coordinates(std::span<const Point<dim>> coordinates) const;

  /// Coordinates of the local dofs, from those of the local nodes.
  std::vector<Point<dim>> dof_points(std::span<const Point<dim>> local_coordinates) const;
};

/// Gauss points per direction: on quadrilaterals eight agree with the print of the thesis to 0.2 %.
struct TensorPoints {
  int quadrilateral = 8;
  int hexahedron = 0;  ///< 0: each takes as many as it needs (chosen_points.h)
};

/// Throws InputError for planar cells with more than four nodes and, with degree 2, for volume
/// meshes of anything but tetrahedra or hexahedra alone, naming the first such cell; and for
/// natural groups that the mesh does not have, or that leave none of the boundary.
template <int dim>
void require_finite_elements(const Topology& topology, int degree,
                             const std::vector<std::string>& natural_groups = {});

/// mesh: needed on the root only, null elsewhere; its coordinates need not be valid. degree: 1 or
/// 2. natural_groups: physical tags or names of the facets with natural conditions; elsewhere on
/// the boundary u is given. Collective. One process numbers dofs as cells come in planar meshes
/// (CG's counts on badly conditioned matrices depend on rounding, hence on the order, and this one
/// comes closest to the thesis' counts), and part by part in volume meshes, whose products are
/// faster then. Throws InputError as require_finite_elements does, and if no dof is free.
template <int dim>
std::shared_ptr<const FiniteElementSpace<dim>> make_finite_element_space(
    const Mesh<dim>* mesh, int degree, const TensorPoints& tensor_points, const Ranks& ranks = {},
    const std::vector<std::string>& natural_groups = {});

}  // namespace smoothfem
