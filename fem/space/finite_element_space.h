// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <memory>
#include <vector>

#include "fem/constraints/node_ties.h"
#include "fem/elements/reference_element.h"
#include "fem/ranks/ranks.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Compressed rows with ascending columns.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// The cells of one element that a process works on; arrays run over the cells first.
struct ElementCells {
  ReferenceElement element;
  std::size_t n_own = 0;  ///< these come first; the others belong to other ranks, but contribute to
                          ///< equations of this one
  std::vector<NodeIndex> vertices;  ///< local nodes in the element's order
  std::vector<std::uint32_t> dofs;  ///< local dofs in the element's order
  std::vector<std::uint32_t>
      entries;  ///< n_dofs x n_dofs each: positions in the pattern's values;
                ///< FiniteElementSpace::absent for rows of other ranks and for boundary dofs
  std::vector<std::uint32_t> kinds;  ///< of each cell: see cell_kinds

  std::size_t n_cells() const { return vertices.size() / element.n_vertices; }
};

/// The facets of one element on which natural conditions hold; arrays run over the facets first.
struct NaturalFacets {
  FacetElement element{};
  std::vector<NodeIndex> vertices{};   ///< local nodes in the element's order, seen from outside
  std::vector<std::uint32_t> dofs{};   ///< local dofs in the element's order
  std::vector<std::uint32_t> kinds{};  ///< of the facets' cells
};

/// Data of continuous Lagrange elements of degree 1 or 2 on a mesh that do not depend on
/// coordinates. Made once and used for every mesh of a smoothing run. Each rank holds the equations
/// of its own dofs and all cells that contribute to them. Local dofs are numbered in this order:
/// free ones of this rank's equations, free ones of other ranks in these equations, boundary dofs,
/// tied dofs. On parts of the boundary with natural conditions dofs are free.
template <int dim>
struct FiniteElementSpace {
  static constexpr std::uint32_t absent = UINT32_MAX;

  int degree = 0;
  Ranks ranks;
  std::size_t n_dofs = 0;  ///< of the whole mesh
  std::size_t n_free = 0;  ///< of the whole mesh: dofs that are not on the boundary
  std::size_t n_own = 0, n_columns = 0, n_local = 0;  ///< ends of the three kinds of local dofs
  std::size_t n_own_boundary = 0;  ///< boundary dofs of this rank: the first of their kind
  /// For each tied dof the dofs whose weighted mean it is; these are not tied.
  std::vector<std::vector<std::pair<std::uint32_t, double>>> ties;

  std::vector<ElementCells> groups;
  std::vector<NaturalFacets>
      natural_facets;  ///< at least the facets that contribute to equations of this rank
  /// Local nodes whose mean is a dof's position: one node, or the ends of an edge, the corners of a
  /// face or of a cell.
  CompressedRows<NodeIndex> dof_nodes;
  std::vector<NodeIndex> nodes;  ///< the mesh's node of each local node
  std::vector<NodeIndex>
      nodes_of_ranks;  ///< on the root: `nodes` of all ranks, one after the other
  std::vector<std::uint32_t> vertex_dof;  ///< the dof at each local node; absent at unused nodes

  SparseMatrix pattern;                     ///< of this rank's equations: n_own x n_columns
  std::vector<std::size_t> column_numbers;  ///< number of each column among all free dofs
  Halo halo;                                ///< for vectors of n_columns entries

  bool is_tied(std::uint32_t dof) const { return dof >= n_local - ties.size(); }
  /// Calls visit(dof, weight) for the dofs that a dof is the weighted mean of; for most dofs it is
  /// the dof itself.
  template <class Visit>
  void for_each_master(std::uint32_t dof, const Visit& visit) const {
    if (!is_tied(dof)) return visit(dof, 1.0);
    for (const auto& [master, weight] : ties[dof - (n_local - ties.size())]) visit(master, weight);
  }
  /// Returns the position of an entry in the pattern's values; absent for rows of other ranks and
  /// for columns that are not free.
  std::uint32_t entry(std::uint32_t row, std::uint32_t column) const;

  /// Returns the coordinates of the local nodes. coordinates: of the mesh, needed on the root only.
  /// Collective.
  std::vector<Point<dim>> local_coordinates(std::span<const Point<dim>> coordinates) const;

  /// Returns the coordinates of the local dofs from those of the local nodes.
  std::vector<Point<dim>> dof_points(std::span<const Point<dim>> local_coordinates) const;
};

/// Gauss points in each direction. On quadrilaterals, eight agree with the thesis to 0.2 %.
struct TensorPoints {
  int quadrilateral = 8;
  int hexahedron = 0;  ///< 0: each uses as many as it needs (adaptive_quadrature.h)
};

/// Checks a mesh for finite elements. Throws InputError for planar cells with more than four nodes,
/// naming the first one. With degree 2, throws it for the first cell of a volume mesh that is not
/// of tetrahedra only or of hexahedra only. Throws it also for natural groups that the mesh does
/// not have, or that cover the whole boundary.
template <int dim>
void require_finite_elements(const Topology& topology, int degree,
                             const std::vector<std::string>& natural_groups = {});

/// Makes a space. mesh: needed on the root only, null elsewhere; its coordinates need not be valid.
/// degree: 1 or 2. natural_groups: physical tags or names of the facets with natural conditions; on
/// the rest of the boundary u is given. Collective.
///
/// One process numbers dofs in the order of cells in planar meshes. (CG's iteration counts on badly
/// conditioned matrices depend on rounding, hence on the order; this one comes closest to the
/// thesis' counts.) In volume meshes dofs are numbered part by part, which makes products faster.
/// ties: on the root; null: none. Ties need degree 1. Throws InputError as require_finite_elements
/// does, for ties with degree 2, and if no dof is free.
template <int dim>
std::shared_ptr<const FiniteElementSpace<dim>> make_finite_element_space(
    const Mesh<dim>* mesh, int degree, const TensorPoints& tensor_points, const Ranks& ranks = {},
    const std::vector<std::string>& natural_groups = {}, const NodeTies* ties = nullptr);

}  // namespace smoothfem
