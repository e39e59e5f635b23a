// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
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

/// The places of a sparse matrix' entries: compressed rows with ascending columns.
struct SparsityPattern {
  std::vector<int> starts{0}, columns{};
  std::size_t n_columns = 0;

  std::size_t n_rows() const { return starts.size() - 1; }
  /// Returns a matrix of zeros in these places.
  SparseMatrix zeros() const;
};

/// The cells of one element that a process works on; arrays run over the cells first.
struct ElementCells {
  ReferenceElement element;
  std::size_t n_own = 0;  ///< these come first; the others belong to other ranks, but contribute to
                          ///< equations of this one
  std::vector<NodeIndex> vertices;  ///< local nodes in the element's order
  /// Local points that determine the cells' mapping, in the order of ReferenceElement::mapping;
  /// empty in straight-sided spaces, where they are the vertices.
  std::vector<NodeIndex> curved_points{};
  std::vector<std::uint32_t> dofs;     ///< local dofs in the element's order
  std::vector<std::uint32_t> entries;  ///< n_dofs x n_dofs each: positions in the pattern's values;
                                       ///< FiniteElementSpace::absent for rows of other ranks and
                                       ///< for boundary dofs. Empty in parts, where memory is short
  std::vector<std::uint32_t> kinds;    ///< of each cell: see cell_kinds
  std::vector<CellIndex> numbers;      ///< of each cell in the mesh

  std::size_t n_cells() const { return vertices.size() / element.n_vertices; }
  /// Returns the first point of a cell's mapping; the others follow.
  const NodeIndex* mapping_points(std::size_t cell) const {
    return curved_points.empty() ? &vertices[cell * element.n_vertices]
                                 : &curved_points[cell * element.mapping.size()];
  }
};

/// The facets of one element on which natural conditions hold; arrays run over the facets first.
struct NaturalFacets {
  FacetElement element{};
  /// Local points that determine the mapping, in the element's order, seen from outside.
  std::vector<NodeIndex> points{};
  std::vector<std::uint32_t> dofs{};   ///< local dofs in the element's order
  std::vector<std::uint32_t> kinds{};  ///< of the facets' cells
};

/// How cells of second order are mapped.
enum class Geometry {
  curved,   ///< by all their nodes
  straight  ///< by their corners alone; boundary values stay those of all nodes
};

/// A point of curved cells without a node: the weighted sum of other local points.
using SubstitutePoint = std::vector<std::pair<NodeIndex, double>>;

/// Data of continuous Lagrange elements of degree 1 or 2 on a mesh that do not depend on
/// coordinates. Made once and used for every mesh of a smoothing run. Each rank holds the equations
/// of its own dofs and all cells that contribute to them. Local dofs are numbered in this order:
/// free ones of this rank's equations, free ones of other ranks in these equations, boundary dofs,
/// tied dofs. On parts of the boundary with natural conditions dofs are free.
///
/// In a curved space the cells are mapped by all their nodes, corners and midside nodes, for
/// elements of both degrees (isoparametric ones of degree 2, superparametric ones of degree 1).
/// Local points are the local nodes, followed by the substitute points.
///
/// In a straight-sided space on a mesh of second order the boundary values of degree 2 are those of
/// the midside nodes, where the boundary is.
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
  /// (In curved cells this is so on the reference cell.)
  CompressedRows<NodeIndex> dof_nodes;
  /// The mesh's node of each local node; in_parts: that of this rank's part.
  std::vector<NodeIndex> nodes;
  bool in_parts = false;  ///< each rank has a part of the mesh (smoothing/parts/mesh_part.h)
  bool is_curved = false;
  std::vector<SubstitutePoint> substitute_points;  ///< each of earlier points
  std::vector<NodeIndex> curved_dof_points;        ///< the local point of each dof; curved spaces
  /// Boundary dofs of a straight-sided space, and the local points on the curve whose values they
  /// have.
  std::vector<std::pair<std::uint32_t, NodeIndex>> boundary_points;
  /// On the root: `nodes` of all ranks, one after the other. Empty in parts.
  std::vector<NodeIndex> nodes_of_ranks;
  /// The dof at each local node; absent at unused nodes, at midside nodes of straight spaces, and
  /// at those where elements of this degree have no dof.
  std::vector<std::uint32_t> vertex_dof;

  SparsityPattern pattern;                  ///< of this rank's equations: n_own x n_columns
  std::vector<std::size_t> column_numbers;  ///< number of each column among all free dofs
  Halo halo;                                ///< for vectors of n_columns entries

  /// True if u is given at a dof of the boundary.
  bool is_given(std::uint32_t dof) const { return dof >= n_columns && !is_tied(dof); }
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

  /// Returns the coordinates of the local points. coordinates: of the mesh, needed on the root
  /// only; in parts, of each rank's part. Collective.
  std::vector<Point<dim>> local_coordinates(std::span<const Point<dim>> coordinates) const;

  /// Returns the coordinates of the local dofs from those of the local points.
  std::vector<Point<dim>> dof_points(std::span<const Point<dim>> local_coordinates) const;

  /// Returns u at the local dofs. local_coordinates: of the local points. dof_points: of the dofs.
  template <class Function>
  Eigen::VectorXd values_at_dofs(const Function& u, std::span<const Point<dim>> local_coordinates,
                                 std::span<const Point<dim>> dof_points) const {
    Eigen::VectorXd values(static_cast<Eigen::Index>(n_local));
    for (std::size_t dof = 0; dof < n_local; ++dof)
      values[static_cast<Eigen::Index>(dof)] = u(dof_points[dof]);
    for (const auto& [dof, point] : boundary_points)
      values[static_cast<Eigen::Index>(dof)] = u(local_coordinates[point]);
    return values;
  }
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

/// True if a mesh has cells of second order that are mapped by all their nodes.
bool has_curved_cells(const Topology& topology, Geometry geometry);

/// Makes a space. mesh: needed on the root only, null elsewhere; its coordinates need not be valid.
/// Or each rank's part of a mesh, for degree 1 without natural groups and ties. degree: 1 or 2.
/// natural_groups: physical tags or names of the facets with natural conditions; on the rest of the
/// boundary u is given. Collective.
///
/// One process numbers dofs in the order of cells in planar meshes. (CG's iteration counts on badly
/// conditioned matrices depend on rounding, hence on the order; this one comes closest to the
/// thesis' counts.) In volume meshes dofs are numbered part by part, which makes products faster.
/// ties: on the root; null: none. Ties need degree 1. Throws InputError as require_finite_elements
/// does, for ties with degree 2 or in a curved space, and if no dof is free.
///
/// geometry: the space is curved if this is so and the mesh has cells of second order. Its linear
/// cells then have the midside nodes of their neighbours, too.
template <int dim>
std::shared_ptr<const FiniteElementSpace<dim>> make_finite_element_space(
    const Mesh<dim>* mesh, int degree, const TensorPoints& tensor_points, const Ranks& ranks = {},
    const std::vector<std::string>& natural_groups = {}, const NodeTies* ties = nullptr,
    Geometry geometry = Geometry::curved);

}  // namespace smoothfem
