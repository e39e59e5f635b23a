#pragma once

#include <array>

#include "fem/finite_element_space.h"
#include "smoothing/mesh/lanes.h"

namespace smoothfem {

/// A straight-sided cell's mapping at one quadrature point.
template <class Real>
struct MappedPoint {
  Vector2<Real> place;
  Real weight;  ///< quadrature weight times the Jacobian's determinant
  Vector2<Real> row_x,
      row_y;  ///< rows of the inverse transposed Jacobian: gradients are multiplied

  SMOOTHFEM_INLINE Vector2<Real> gradient(const double* reference) const {
    return {reference[0] * row_x.x + reference[1] * row_x.y,
            reference[0] * row_y.x + reference[1] * row_y.y};
  }
};

/// vertices: of the cell in the element's order. q: number of the point in the table.
template <std::size_t n_vertices, class Real>
SMOOTHFEM_INLINE MappedPoint<Real> map_point(
    const QuadratureTable& table, std::size_t q,
    const std::array<Vector2<Real>, n_vertices>& vertices) {
  Vector2<Real> place{}, column0{}, column1{};
  for (std::size_t v = 0; v < n_vertices; ++v) {
    const double* gradient = &table.geometry_gradient[2 * (q * n_vertices + v)];
    place = place + table.geometry[q * n_vertices + v] * vertices[v];
    column0 = column0 + gradient[0] * vertices[v];
    column1 = column1 + gradient[1] * vertices[v];
  }
  const Real determinant = cross(column0, column1);
  const Real inverse = 1.0 / determinant;
  return {place,
          table.weights[q] * determinant,
          {inverse * column1.y, -inverse * column0.y},
          {-inverse * column1.x, inverse * column0.x}};
}

/// Upper triangles, row by row, of a cell's stiffness and mass matrix.
template <std::size_t n_dofs, class Real>
struct CellMatrices {
  static constexpr std::size_t n_entries = n_dofs * (n_dofs + 1) / 2;
  std::array<Real, n_entries> stiffness, mass;

  template <std::size_t n_vertices>
  SMOOTHFEM_INLINE void compute(const QuadratureTable& table,
                                const std::array<Vector2<Real>, n_vertices>& vertices) {
    stiffness.fill(Real{});
    mass.fill(Real{});
    for (std::size_t q = 0; q < table.n_points; ++q) {
      const auto mapped = map_point(table, q, vertices);
      const double* shape = &table.shape[q * n_dofs];
      std::array<Vector2<Real>, n_dofs> gradients;
      for (std::size_t i = 0; i < n_dofs; ++i)
        gradients[i] = mapped.gradient(&table.shape_gradient[2 * (q * n_dofs + i)]);
      for (std::size_t i = 0, p = 0; i < n_dofs; ++i) {
        const auto weighted_gradient = mapped.weight * gradients[i];
        const Real weighted_shape = shape[i] * mapped.weight;
        for (std::size_t j = i; j < n_dofs; ++j, ++p) {
          stiffness[p] += dot(weighted_gradient, gradients[j]);
          mass[p] += shape[j] * weighted_shape;
        }
      }
    }
  }
};

/// Up to n_lanes cells of one element, worked on together; missing ones repeat the last.
template <std::size_t n_vertices>
struct CellBatch {
  std::array<std::uint32_t, n_lanes> cells;
  std::size_t size;
  std::array<Vector2<Lanes>, n_vertices> vertices;

  CellBatch(const FiniteElementSpace& space, const std::vector<Point<2>>& x,
            const std::uint32_t* first, std::size_t count)
      : size(count) {
    for (std::size_t l = 0; l < n_lanes; ++l) {
      cells[l] = first[l < count ? l : count - 1];
      const auto nodes = space.cell_vertices[cells[l]];
      for (std::size_t v = 0; v < n_vertices; ++v) {
        vertices[v].x[l] = x[nodes[v]].x();
        vertices[v].y[l] = x[nodes[v]].y();
      }
    }
  }
};

/// Calls visit.operator()<n_dofs, n_vertices>(element, cells) for the cells of each element there
/// are.
template <class Visit>
void for_each_element(const FiniteElementSpace& space, const Visit& visit) {
  const bool linear = space.degree == 1;
  if (!space.triangle_cells.empty()) {
    if (linear)
      visit.template operator()<3, 3>(space.triangle, space.triangle_cells);
    else
      visit.template operator()<6, 3>(space.triangle, space.triangle_cells);
  }
  if (!space.quadrilateral_cells.empty()) {
    if (linear)
      visit.template operator()<4, 4>(space.quadrilateral, space.quadrilateral_cells);
    else
      visit.template operator()<9, 4>(space.quadrilateral, space.quadrilateral_cells);
  }
}

}  // namespace smoothfem
