// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "fem/elements/curved_cells.h"
#include "smoothing/mesh/element_type.h"

namespace smoothfem {

/// Values at the points of one quadrature rule on a reference cell. All arrays run over the points
/// first, then over the dofs (or the points of the mapping). Gradients have an entry for each
/// dimension.
struct QuadratureTable {
  std::size_t n_points = 0;
  std::vector<double> weights;
  std::vector<double> shape, shape_gradient;        ///< of the finite element
  std::vector<double> geometry, geometry_gradient;  ///< of the mapping, at MappingPoints
};

/// Integrals over the reference simplex. Its mapping is affine, so that integrals over a cell are
/// combinations of them. Upper triangles, row by row.
struct AffineTable {
  std::vector<double> mass;  ///< of phi_i phi_j
  /// Integrals for each pair of directions a <= b, in the order 00, 01, 11 or 00, 01, 02, 11, 12,
  /// 22: of d_a phi_i d_b phi_j and, if a < b, also of d_b phi_i d_a phi_j.
  std::vector<double> stiffness;
};

/// A Lagrange element on its reference cell. Vertices and dofs are in deal.II's order.
struct ReferenceElement {
  ElementType type;
  std::size_t n_vertices = 0;
  std::size_t n_dofs = 0;
  MappingPoints mapping;
  /// Shape functions of degree 1 at the dofs' support points, n_dofs x n_vertices: the positions of
  /// the dofs in straight-sided cells.
  std::vector<double> support;
  AffineTable affine;  ///< straight-sided simplices: stiffness, mass and load
  QuadratureTable
      matrices;            ///< other cells: stiffness, mass and load; all cells: load by quadrature
  QuadratureTable errors;  ///< for norms and errors
  /// Finer and finer rules for both, for cells that need them (adaptive_quadrature.h); empty: one
  /// rule for all cells.
  std::vector<QuadratureTable> finer{};
  QuadratureTable check{};  ///< with finer rules: a coarser rule that checks the first one

  /// Returns the vertices whose mean is the support point of a dof, ascending.
  std::vector<std::size_t> vertices_around(std::size_t dof) const {
    std::vector<std::size_t> around;
    for (std::size_t v = 0; v < n_vertices; ++v)
      if (support[dof * n_vertices + v] > 1e-12) around.push_back(v);
    return around;
  }
  bool is_curved() const { return mapping.size() > n_vertices; }
  std::size_t n_rules() const { return 1 + finer.size(); }
  /// In the order of their points; only 0 for simplices.
  const QuadratureTable& rule(std::size_t level) const {
    return level == 0 ? matrices : finer[level - 1];
  }
};

/// A facet of cells as a separate element, with the cells' shape functions on it.
struct FacetElement {
  std::size_t n_vertices = 0;  ///< 2: an edge; 3, 4: a triangle or quadrilateral in space
  std::size_t n_dofs = 0;
  MappingPoints mapping;
  std::vector<double> support;  ///< as in ReferenceElement
  QuadratureTable rule;         ///< 8 Gauss points per direction; degree 11 on triangles
};

/// Makes an element of degree 1 or 2 on triangles (3/6 nodes), quadrilaterals (4/9), tetrahedra
/// (4/10) or hexahedra (8/27), or of degree 1 on pyramids and prisms.
///
/// Simplices: exact matrices; errors by a rule of degree 11 on triangles, and of degree 5 (elements
/// of degree 1) or 7 (degree 2) on tetrahedra. Other cells: a tensor Gauss rule with
/// n_tensor_points in each direction for both; on pyramids and prisms it is collapsed. No rule is
/// exact, as the stiffness of a distorted cell is rational. 0 points: the rules of
/// adaptive_quadrature::rule_sequence, of which each cell uses what it needs.
///
/// curved: the mapping is of second order. The integrands on simplices are then rational, too, and
/// matrices, loads and errors have the same rule, of degree 11 on triangles and 7 on tetrahedra.
/// (Degree 2 would keep the order of the error; Ciarlet, Raviart 1972.)
ReferenceElement make_reference_element(ElementType type, int degree, int n_tensor_points,
                                        bool curved = false);

/// Makes the values at the support points of the element's dofs, in their order; without weights.
QuadratureTable make_support_table(ElementType type, int degree);

/// Additional rules of an element for the energy of a solution (fem/adaptivity/energy.h).
struct EnergyRules {
  QuadratureTable gradients;          ///< on simplices: exact for products of two gradients
  std::vector<QuadratureTable> load;  ///< for f, finer and finer: up to cells that are halved twice
};

/// type: triangle, quadrilateral, tetrahedron or hexahedron.
EnergyRules make_energy_rules(ElementType type, int degree);

/// n_vertices: 2, 3 or 4; degree: 1 or 2.
FacetElement make_facet_element(std::size_t n_vertices, int degree, bool curved = false);

}  // namespace smoothfem
