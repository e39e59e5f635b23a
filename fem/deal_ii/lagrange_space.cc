// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/deal_ii/lagrange_space.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_pyramid_p.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_wedge_p.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/fe/mapping_q.h>

#include <algorithm>
#include <memory>

#include "fem/elements/quadrature_rules.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

using dealii::ReferenceCell;
using dealii::ReferenceCells::Pyramid;
using dealii::ReferenceCells::Wedge;

/// Throws InputError for a degree that deal.II does not have.
template <int dim>
void check_degree(const std::vector<ReferenceCell>& types, unsigned int degree) {
  if (dim == 3 && types.size() > 1)
    throw InputError(
        "deal.II 9.4 cannot number the degrees of freedom of volume meshes with several types of "
        "cells; take a mesh of one type, or the solver 'poisson'");
  unsigned int most = types.size() == 1 ? 4 : 2;
  for (const ReferenceCell& type : types) {
    if (type.is_simplex()) most = std::min(most, 2U);
    if (has_facets_of_two_shapes(type)) most = 1;
  }
  if (degree > most)
    throw InputError("deal.II has no finite elements of degree " + std::to_string(degree) +
                     " for all cells of this mesh; the highest is " + std::to_string(most));
}

template <int dim>
std::unique_ptr<dealii::FiniteElement<dim>> element_of(const ReferenceCell& type,
                                                       unsigned int degree) {
  if (type.is_simplex()) return std::make_unique<dealii::FE_SimplexP<dim>>(degree);
  if constexpr (dim == 3) {
    if (type == Pyramid) return std::make_unique<dealii::FE_PyramidP<3>>(degree);
    if (type == Wedge) return std::make_unique<dealii::FE_WedgeP<3>>(degree);
  }
  return std::make_unique<dealii::FE_Q<dim>>(degree);
}

template <int dim>
dealii::Quadrature<dim> rule_of(const ReferenceCell& type, unsigned int degree,
                                unsigned int n_points) {
  if (type.is_simplex()) return simplex_error_rule<dim>(static_cast<int>(degree));
  return gauss_rule<dim>(type == Pyramid ? ElementType::pyramid
                         : type == Wedge ? ElementType::prism
                         : dim == 2      ? ElementType::quadrilateral
                                         : ElementType::hexahedron,
                         n_points);
}

}  // namespace

template <int dim>
LagrangeSpace<dim>::LagrangeSpace(const dealii::Triangulation<dim>& triangulation,
                                  unsigned int degree, unsigned int n_components,
                                  unsigned int n_points, std::shared_ptr<const NodeTies> given)
    : dofs(triangulation), ties(std::move(given)) {
  const auto types = triangulation.get_reference_cells();
  check_degree<dim>(types, degree);
  if (ties && degree > 1)
    throw InputError(
        "hanging and periodic nodes need finite elements of degree 1; write 'set degrees = 1'");
  if (n_points == 0) n_points = degree + 4;
  for (const ReferenceCell& type : types) {
    elements.push_back(dealii::FESystem<dim>(*element_of<dim>(type, degree), n_components));
    hats.push_back(*element_of<dim>(type, 1));
    if (type.is_hyper_cube())
      mappings.push_back(dealii::MappingQ<dim>(1));
    else
      mappings.push_back(dealii::MappingFE<dim>(*element_of<dim>(type, 1)));
    rules.push_back(rule_of<dim>(type, degree, n_points));
    if (dim == 3 && type.is_simplex())
      facet_rules.push_back(dealii::QGaussSimplex<dim - 1>(std::min(degree + 1, 4U)));
    else
      facet_rules.push_back(dealii::QGauss<dim - 1>(n_points));
  }
  for (const auto& cell : own_cells())
    cell->set_active_fe_index(static_cast<unsigned int>(
        std::find(types.begin(), types.end(), cell->reference_cell()) - types.begin()));
  dofs.distribute_dofs(elements);
  dealii::DoFTools::extract_locally_relevant_dofs(dofs, relevant_dofs);
}

template <int dim>
std::map<dealii::types::global_dof_index, dealii::Point<dim>> LagrangeSpace<dim>::support_points()
    const {
  std::map<dealii::types::global_dof_index, dealii::Point<dim>> points;
  dealii::DoFTools::map_dofs_to_support_points(mappings, dofs, points);
  return points;
}

template <int dim>
void LagrangeSpace<dim>::add_ties(dealii::AffineConstraints<double>& constraints) const {
  if (!ties) return;
  const unsigned int n_components = elements[0].n_components();
  std::vector<dealii::types::global_dof_index> of_nodes(n_components *
                                                        dofs.get_triangulation().n_vertices());
  for (const auto& cell : dofs.active_cell_iterators())
    for (const unsigned int v : cell->vertex_indices())
      for (unsigned int c = 0; c < n_components; ++c)
        of_nodes[n_components * cell->vertex_index(v) + c] =
            cell->vertex_dof_index(v, c, cell->active_fe_index());
  for (const NodeTie& tie : ties->nodes)
    for (unsigned int c = 0; c < n_components; ++c) {
      const auto dof = of_nodes[n_components * tie.node + c];
      if (constraints.is_constrained(dof)) continue;
      constraints.add_line(dof);
      for (const auto& [master, weight] : tie.masters)
        constraints.add_entry(dof, of_nodes[n_components * master + c], weight);
    }
}

template struct LagrangeSpace<2>;
template struct LagrangeSpace<3>;

}  // namespace smoothfem
