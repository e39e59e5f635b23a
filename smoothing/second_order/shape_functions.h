// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "smoothing/mesh/point.h"

/// Lagrange shape functions of the elements of second order in midside_nodes.h. Their reference
/// domains have the corners
///
///   triangle        (0,0) (1,0) (0,1)
///   quadrilateral   (0,0) (1,0) (1,1) (0,1)
///   tetrahedron     (0,0,0) (1,0,0) (0,1,0) (0,0,1)
///   pyramid         those of the quadrilateral at z = 0, and (0,0,1)
///   prism           those of the triangle at z = 0, then at z = 1
///   hexahedron      those of the quadrilateral at z = 0, then at z = 1
///
/// and midside nodes in the middle of edges, faces and cells. Spaces of functions:
///
///   TRI6, TET10             polynomials of degree 2
///   TRI7                    those, and the bubble x y (1-x-y)
///   QUAD9, HEX27            polynomials of degree 2 in each coordinate
///   QUAD8, HEX20            products of powers with at most one square (serendipity)
///   PRISM18                 degree 2 in (x, y), times degree 2 in z
///   PRISM15                 without z^2 times x^2, x y and y^2
///   PYRAMID14               xi^i eta^j (1-z)^max(i,j) z^k with k <= 2 - max(i,j), i, j <= 2, where
///                           xi = x/(1-z), eta = y/(1-z) (Bergot, Cohen and Durufle 2010,
///                           doi 10.1007/s10915-009-9334-9)
///   PYRAMID13               without i = j = 2, as in Gmsh
///
/// Collapsed coordinates are (xi, eta, z) in a pyramid, and (x, y, z) in other elements. There, all
/// functions are polynomials. The apex of a pyramid is the face z = 1 of the unit cube.

namespace smoothfem {

/// Most nodes of an element of second order.
inline constexpr std::size_t max_second_order_nodes = 27;

/// An element of second order of planar or volume meshes. Dimension and nodes determine it.
struct SecondOrderType {
  int dim;
  std::size_t n_corners, n_nodes;
};
/// All of them.
inline constexpr std::array<SecondOrderType, 11> second_order_types{{{2, 3, 6},
                                                                     {2, 3, 7},
                                                                     {2, 4, 8},
                                                                     {2, 4, 9},
                                                                     {3, 4, 10},
                                                                     {3, 5, 13},
                                                                     {3, 5, 14},
                                                                     {3, 6, 15},
                                                                     {3, 6, 18},
                                                                     {3, 8, 20},
                                                                     {3, 8, 27}}};

/// The shape functions of one type. Points have z = 0 in planar elements.
class ShapeFunctions {
 public:
  /// type: of second_order_types.
  explicit ShapeFunctions(const SecondOrderType& type);

  const SecondOrderType& type() const { return type_; }
  /// Returns the reference coordinates of the nodes, in the order of a row.
  const std::vector<Point<3>>& nodes() const { return nodes_; }

  /// Returns the values of all functions at a point of the reference domain. Computed in a more
  /// precise type and rounded once.
  std::vector<double> values(const Point<3>& x) const;
  /// Returns their gradients. At the apex of a pyramid these depend on the direction from there;
  /// the result is their limit along the line from the middle of the base.
  std::vector<Point<3>> gradients(const Point<3>& x) const;

  /// Returns the collapsed coordinates of a point.
  Point<3> collapsed(const Point<3>& x) const;
  /// Returns derivatives of all functions at a point in collapsed coordinates: those by x, y, z or,
  /// in a pyramid, by xi divided by 1-z, by eta divided by 1-z, and by z with xi and eta fixed. The
  /// determinant of the derivatives of a mapping is det J in both cases. They are polynomials and
  /// rounded once.
  std::vector<Point<3>> collapsed_derivatives(const Point<3>& u) const;

 private:
  /// More precise than double, so that one rounding is the only considerable error.
  using Real = long double;
  /// u^powers[0] v^powers[1] w^powers[2] l^power_of_l; l: 1-x-y in triangles, 1-z in pyramids.
  struct Monomial {
    std::array<int, 3> powers{};
    int power_of_l = 0;
  };

  Real value(const Monomial& monomial, const Point<3>& u) const;
  Real derivative(const Monomial& monomial, int d, const Point<3>& u) const;

  SecondOrderType type_;
  std::vector<Point<3>> nodes_;
  std::vector<Monomial> monomials_;
  std::vector<Real> coefficients_;  ///< of monomial m in function k at m * n_nodes + k
};

/// Returns the position in second_order_types of the elements with n_nodes nodes. dim: 2 or 3.
/// Throws InputError if there are none.
std::size_t second_order_type(int dim, std::size_t n_nodes);

/// Returns the shape functions of these elements.
const ShapeFunctions& shape_functions(int dim, std::size_t n_nodes);

namespace detail {
template <class Table, std::size_t type>
const Table& table_of_type() {
  static const Table table(second_order_types[type]);
  return table;
}
}  // namespace detail

/// Returns the table of these elements. It is made of their SecondOrderType at the first use.
template <class Table>
const Table& table_of_type(int dim, std::size_t n_nodes) {
  return [&]<std::size_t... type>(std::index_sequence<type...>)->const Table& {
    constexpr std::array<const Table& (*)(), sizeof...(type)> tables{
        detail::table_of_type<Table, type>...};
    return tables[second_order_type(dim, n_nodes)]();
  }
  (std::make_index_sequence<second_order_types.size()>{});
}

}  // namespace smoothfem
