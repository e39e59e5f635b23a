// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/reference_element.h"

#include <deal.II/fe/fe_pyramid_p.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_wedge_p.h>

#include <array>
#include <memory>

#include "fem/elements/adaptive_quadrature.h"
#include "fem/elements/mapping_functions.h"
#include "fem/elements/quadrature_rules.h"
#include "fem/elements/single_threaded.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

/// Pyramids and prisms: degree 1 only.
template <int dim>
std::unique_ptr<dealii::FiniteElement<dim>> lagrange_element(ElementType type, int degree) {
  if (is_simplex(type)) return std::make_unique<dealii::FE_SimplexP<dim>>(degree);
  if constexpr (dim == 3) {
    if (type == ElementType::pyramid) return std::make_unique<dealii::FE_PyramidP<3>>(degree);
    if (type == ElementType::prism) return std::make_unique<dealii::FE_WedgeP<3>>(degree);
  }
  return std::make_unique<dealii::FE_Q<dim>>(degree);
}

template <int dim>
QuadratureTable make_table(const dealii::FiniteElement<dim>& element,
                           const MappingFunctions<dim>& mapping,
                           const dealii::Quadrature<dim>& rule) {
  // For unknown degrees deal.II 9.4 returns empty rules, in Release without an error.
  if (rule.size() == 0) throw std::logic_error("empty quadrature rule");
  QuadratureTable table;
  table.n_points = rule.size();
  table.weights = rule.get_weights();
  for (unsigned int q = 0; q < rule.size(); ++q) {
    append_lagrange<dim>(element, rule.point(q), table.shape, table.shape_gradient);
    mapping.append(rule.point(q), table.geometry, table.geometry_gradient);
  }
  return table;
}

/// table: of a rule that is exact for products of two shape functions.
AffineTable make_affine_table(const QuadratureTable& table, std::size_t n_dofs, std::size_t dim) {
  AffineTable affine;
  const auto integrate = [&](const auto& integrand, std::vector<double>& entries) {
    for (std::size_t i = 0; i < n_dofs; ++i)
      for (std::size_t j = i; j < n_dofs; ++j) {
        double sum = 0.0;
        for (std::size_t q = 0; q < table.n_points; ++q)
          sum += table.weights[q] * integrand(q * n_dofs + i, q * n_dofs + j);
        entries.push_back(sum);
      }
  };
  integrate([&](std::size_t i, std::size_t j) { return table.shape[i] * table.shape[j]; },
            affine.mass);
  const auto& gradient = table.shape_gradient;
  for (std::size_t a = 0; a < dim; ++a)
    for (std::size_t b = a; b < dim; ++b)
      integrate(
          [&](std::size_t i, std::size_t j) {
            const double ab = gradient[dim * i + a] * gradient[dim * j + b];
            return a == b ? ab : ab + gradient[dim * i + b] * gradient[dim * j + a];
          },
          affine.stiffness);
  return affine;
}

/// Values of the shape functions of degree 1 at the support points of the element's dofs.
template <int dim>
std::vector<double> support_of(const dealii::FiniteElement<dim>& element,
                               const dealii::FiniteElement<dim>& geometry) {
  std::vector<double> support;
  for (const auto& point : element.get_unit_support_points())
    for (unsigned int v = 0; v < geometry.n_dofs_per_cell(); ++v)
      support.push_back(geometry.shape_value(v, point));
  return support;
}

template <int dim>
ReferenceElement make_element(ElementType type, int degree, int n_tensor_points, bool curved) {
  const auto element = lagrange_element<dim>(type, degree);
  const auto linear = lagrange_element<dim>(type, 1);
  const MappingFunctions<dim> mapping(*linear, curved);
  ReferenceElement reference{.type = type,
                             .n_vertices = linear->n_dofs_per_cell(),
                             .n_dofs = element->n_dofs_per_cell(),
                             .mapping = mapping.points(),
                             .support = support_of(*element, *linear),
                             .affine = {},
                             .matrices = {},
                             .errors = {}};
  if (is_simplex(type)) {
    const auto exact = make_table<dim>(*element, mapping, simplex_matrix_rule<dim>());
    reference.affine = make_affine_table(exact, reference.n_dofs, dim);
    reference.errors =
        make_table<dim>(*element, mapping, simplex_error_rule<dim>(curved ? 2 : degree));
    reference.matrices = curved ? reference.errors : exact;
  } else {
    const auto table = [&](int n_points) {
      return make_table<dim>(*element, mapping,
                             gauss_rule<dim>(type, static_cast<unsigned int>(n_points)));
    };
    const bool is_chosen = n_tensor_points == 0;
    reference.matrices =
        table(is_chosen ? adaptive_quadrature::rule_sequence.front() : n_tensor_points);
    reference.errors = reference.matrices;
    if (is_chosen) {
      reference.check = table(adaptive_quadrature::check_points);
      for (std::size_t level = 1; level < adaptive_quadrature::rule_sequence.size(); ++level)
        reference.finer.push_back(table(adaptive_quadrature::rule_sequence[level]));
    }
  }
  return reference;
}

/// Corners of the simplices that result from halving the edges of a reference simplex, as multiples
/// of 1/2: one at each corner, and in space four of the octahedron in between (Bey 1995).
template <int dim>
std::vector<std::array<dealii::Point<dim>, dim + 1>> halved_simplices() {
  std::array<dealii::Point<dim>, dim + 1> corners;
  for (unsigned int d = 0; d < dim; ++d) corners[d + 1][d] = 1.0;
  const auto middle = [&](std::size_t a, std::size_t b) {
    return dealii::Point<dim>(0.5 * (corners[a] + corners[b]));
  };
  std::vector<std::array<dealii::Point<dim>, dim + 1>> halved;
  for (std::size_t a = 0; a <= dim; ++a) {
    halved.emplace_back();
    for (std::size_t b = 0; b <= dim; ++b) halved.back()[b] = middle(a, b);
  }
  if constexpr (dim == 2) {
    halved.push_back({middle(0, 1), middle(1, 2), middle(0, 2)});
  } else {
    halved.push_back({middle(0, 1), middle(0, 2), middle(0, 3), middle(1, 3)});
    halved.push_back({middle(0, 1), middle(0, 2), middle(1, 2), middle(1, 3)});
    halved.push_back({middle(0, 2), middle(0, 3), middle(1, 3), middle(2, 3)});
    halved.push_back({middle(0, 2), middle(1, 2), middle(1, 3), middle(2, 3)});
  }
  return halved;
}

/// The rule on each of these simplices.
template <int dim>
dealii::Quadrature<dim> on_halved_simplices(const dealii::Quadrature<dim>& rule) {
  const auto simplices = halved_simplices<dim>();
  std::vector<dealii::Point<dim>> points;
  std::vector<double> weights;
  for (const auto& corners : simplices)
    for (unsigned int q = 0; q < rule.size(); ++q) {
      dealii::Point<dim> point = corners[0];
      for (unsigned int d = 0; d < dim; ++d)
        point += rule.point(q)[d] * (corners[d + 1] - corners[0]);
      points.push_back(point);
      weights.push_back(rule.weight(q) / static_cast<double>(simplices.size()));
    }
  return {points, weights};
}

/// Rules of degrees 5, 7 and 11 on triangles, 3, 5 and 7 on tetrahedra, followed by those on halved
/// cells.
template <int dim>
std::vector<dealii::Quadrature<dim>> load_rules(ElementType type) {
  std::vector<dealii::Quadrature<dim>> rules;
  if (is_simplex(type)) {
    for (const unsigned int n : dim == 2 ? std::array{3U, 4U, 6U} : std::array{2U, 3U, 4U})
      rules.push_back(dealii::QWitherdenVincentSimplex<dim>(n));
    rules.push_back(on_halved_simplices<dim>(rules.back()));
    if (dim == 2) rules.push_back(on_halved_simplices<dim>(rules.back()));
  } else {
    for (const unsigned int n : dim == 2 ? std::array{3U, 5U, 8U, 16U} : std::array{2U, 3U, 5U, 8U})
      rules.push_back(dealii::QGauss<dim>(n));
  }
  return rules;
}

template <int dim>
EnergyRules make_rules_of_energy(ElementType type, int degree) {
  const auto element = lagrange_element<dim>(type, degree);
  const auto linear = lagrange_element<dim>(type, 1);
  const MappingFunctions<dim> mapping(*linear, false);
  const auto table = [&](const dealii::Quadrature<dim>& rule) {
    return make_table<dim>(*element, mapping, rule);
  };
  EnergyRules rules;
  if (is_simplex(type))
    rules.gradients = table(dealii::QGaussSimplex<dim>(static_cast<unsigned int>(degree)));
  for (const auto& rule : load_rules<dim>(type)) rules.load.push_back(table(rule));
  return rules;
}

template <int dim>
QuadratureTable make_table_at_support(ElementType type, int degree) {
  const auto element = lagrange_element<dim>(type, degree), linear = lagrange_element<dim>(type, 1);
  const auto& points = element->get_unit_support_points();
  return make_table<dim>(*element, MappingFunctions<dim>(*linear, false),
                         dealii::Quadrature<dim>(points, std::vector<double>(points.size(), 0.0)));
}

/// dim: of the facet.
template <int dim>
FacetElement make_facet(bool simplex, int degree, bool curved) {
  const auto lagrange = [&](int of_degree) -> std::unique_ptr<dealii::FiniteElement<dim>> {
    if (simplex) return std::make_unique<dealii::FE_SimplexP<dim>>(of_degree);
    return std::make_unique<dealii::FE_Q<dim>>(of_degree);
  };
  constexpr unsigned int n_points = 8;
  const auto element = lagrange(degree), linear = lagrange(1);
  const MappingFunctions<dim> mapping(*linear, curved);
  FacetElement facet{.n_vertices = linear->n_dofs_per_cell(),
                     .n_dofs = element->n_dofs_per_cell(),
                     .mapping = mapping.points(),
                     .support = support_of(*element, *linear),
                     .rule = {}};
  if constexpr (dim == 2)
    facet.rule = make_table<2>(
        *element, mapping, simplex ? simplex_error_rule<2>(degree) : dealii::QGauss<2>(n_points));
  else
    facet.rule = make_table<1>(*element, mapping, dealii::QGauss<1>(n_points));
  return facet;
}

}  // namespace

FacetElement make_facet_element(std::size_t n_vertices, int degree, bool curved) {
  keep_deal_ii_single_threaded();
  return n_vertices == 2 ? make_facet<1>(false, degree, curved)
                         : make_facet<2>(n_vertices == 3, degree, curved);
}

QuadratureTable make_support_table(ElementType type, int degree) {
  keep_deal_ii_single_threaded();
  return dimension_of(type) == 2 ? make_table_at_support<2>(type, degree)
                                 : make_table_at_support<3>(type, degree);
}

EnergyRules make_energy_rules(ElementType type, int degree) {
  keep_deal_ii_single_threaded();
  return dimension_of(type) == 2 ? make_rules_of_energy<2>(type, degree)
                                 : make_rules_of_energy<3>(type, degree);
}

ReferenceElement make_reference_element(ElementType type, int degree, int n_tensor_points,
                                        bool curved) {
  keep_deal_ii_single_threaded();
  return dimension_of(type) == 2 ? make_element<2>(type, degree, n_tensor_points, curved)
                                 : make_element<3>(type, degree, n_tensor_points, curved);
}

}  // namespace smoothfem
