#include "fem/reference_element.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>

#include <memory>

#include "smoothing/mesh/input_error.h"

namespace smoothfem {

namespace {

std::unique_ptr<dealii::FiniteElement<2>> lagrange_element(ElementType type, int degree) {
  if (type == ElementType::triangle) return std::make_unique<dealii::FE_SimplexP<2>>(degree);
  return std::make_unique<dealii::FE_Q<2>>(degree);
}

/// Appends values and gradients of all shape functions at one point.
void append_shapes(const dealii::FiniteElement<2>& element, const dealii::Point<2>& point,
                   std::vector<double>& values, std::vector<double>& gradients) {
  for (unsigned int i = 0; i < element.n_dofs_per_cell(); ++i) {
    values.push_back(element.shape_value(i, point));
    const auto gradient = element.shape_grad(i, point);
    gradients.push_back(gradient[0]);
    gradients.push_back(gradient[1]);
  }
}

QuadratureTable make_table(const dealii::FiniteElement<2>& element,
                           const dealii::FiniteElement<2>& geometry,
                           const dealii::Quadrature<2>& rule) {
  // deal.II 9.4 gives empty rules for degrees it does not know, without a word in Release.
  if (rule.size() == 0) throw std::logic_error("empty quadrature rule");
  QuadratureTable table;
  table.n_points = rule.size();
  table.weights = rule.get_weights();
  for (unsigned int q = 0; q < rule.size(); ++q) {
    append_shapes(element, rule.point(q), table.shape, table.shape_gradient);
    append_shapes(geometry, rule.point(q), table.geometry, table.geometry_gradient);
  }
  return table;
}

}  // namespace

ReferenceElement make_reference_element(ElementType type, int degree, int n_quadrilateral_points) {
  const auto element = lagrange_element(type, degree);
  const auto geometry = lagrange_element(type, 1);
  ReferenceElement reference{.type = type,
                             .n_vertices = geometry->n_dofs_per_cell(),
                             .n_dofs = element->n_dofs_per_cell(),
                             .support = {},
                             .matrices = {},
                             .errors = {}};
  for (const auto& point : element->get_unit_support_points())
    for (unsigned int v = 0; v < geometry->n_dofs_per_cell(); ++v)
      reference.support.push_back(geometry->shape_value(v, point));
  if (type == ElementType::triangle) {
    // Seven points, degree 5: exact for products of two shape functions of degree 2.
    reference.matrices = make_table(*element, *geometry, dealii::QGaussSimplex<2>(3));
    reference.errors = make_table(*element, *geometry, dealii::QWitherdenVincentSimplex<2>(6));
  } else {
    reference.matrices = make_table(*element, *geometry, dealii::QGauss<2>(n_quadrilateral_points));
    reference.errors = reference.matrices;
  }
  return reference;
}

}  // namespace smoothfem
