// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/fe/fe_q.h>

#include <vector>

#include "fem/elements/curved_cells.h"
#include "smoothing/second_order/shape_functions.h"

// Includes deal.II's headers: for sources of this library only.

namespace smoothfem {

/// Appends the values and gradients of all functions of an element at a point.
template <int dim>
void append_lagrange(const dealii::FiniteElement<dim>& element, const dealii::Point<dim>& point,
                     std::vector<double>& values, std::vector<double>& gradients) {
  for (unsigned int i = 0; i < element.n_dofs_per_cell(); ++i) {
    values.push_back(element.shape_value(i, point));
    const auto gradient = element.shape_grad(i, point);
    for (int d = 0; d < dim; ++d) gradients.push_back(gradient[d]);
  }
}

/// The functions of a cell's mapping: one for each of its points (MappingPoints), which is 1 there
/// and 0 at the others. On straight-sided cells these are deal.II's functions of degree 1, on
/// curved ones the shape functions of TRI7, QUAD9, TET10, PYRAMID14, PRISM18 and HEX27.
template <int dim>
class MappingFunctions {
 public:
  /// linear: the element of degree 1; must outlive this.
  MappingFunctions(const dealii::FiniteElement<dim>& linear, bool curved)
      : linear_(linear),
        curved_(curved),
        points_(mapping_points(dim, linear.n_dofs_per_cell(), curved)) {}

  const MappingPoints& points() const { return points_; }

  /// Appends the values and gradients of all functions at a point.
  void append(const dealii::Point<dim>& point, std::vector<double>& values,
              std::vector<double>& gradients) const {
    if (!curved_)
      append_lagrange(linear_, point, values, gradients);
    else if constexpr (dim == 1)
      append_lagrange<1>(dealii::FE_Q<1>(2), point, values, gradients);
    else
      append_curved(point, values, gradients);
  }

 private:
  /// The reference cells of deal.II and of ShapeFunctions differ by an affine mapping, which the
  /// functions of degree 1 represent.
  void append_curved(const dealii::Point<dim>& point, std::vector<double>& values,
                     std::vector<double>& gradients) const {
    const ShapeFunctions& shapes = shape_functions(dim, points_.size());
    const auto n_vertices = linear_.n_dofs_per_cell();
    Point<3> mapped = Point<3>::Zero();
    std::array<Point<3>, dim> columns;
    columns.fill(Point<3>::Zero());
    for (unsigned int v = 0; v < n_vertices; ++v) {
      const Point<3>& corner = shapes.nodes()[deal_ii_position(dim, n_vertices, v)];
      mapped += linear_.shape_value(v, point) * corner;
      for (unsigned int d = 0; d < dim; ++d) columns[d] += linear_.shape_grad(v, point)[d] * corner;
    }
    const auto of_nodes = shapes.values(mapped);
    const auto gradients_of_nodes = shapes.gradients(mapped);
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const std::size_t node = p < n_vertices ? deal_ii_position(dim, n_vertices, p) : p;
      values.push_back(of_nodes[node]);
      for (const Point<3>& column : columns)
        gradients.push_back(gradients_of_nodes[node].dot(column));
    }
  }

  const dealii::FiniteElement<dim>& linear_;
  bool curved_;
  MappingPoints points_;
};

}  // namespace smoothfem
