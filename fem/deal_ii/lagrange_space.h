// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/filtered_iterator.h>
#include <deal.II/hp/fe_collection.h>
#include <deal.II/hp/fe_values.h>
#include <deal.II/hp/mapping_collection.h>
#include <deal.II/hp/q_collection.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <map>
#include <memory>

#include "fem/constraints/node_ties.h"

namespace smoothfem {

/// True for cells whose facets have two shapes: deal.II 9.4 has no quadrature on these.
inline bool has_facets_of_two_shapes(const dealii::ReferenceCell& type) {
  return type == dealii::ReferenceCells::Pyramid || type == dealii::ReferenceCells::Wedge;
}

/// Lagrange elements on a triangulation, which may have several types of cells: for each type an
/// element, a straight-sided mapping and quadrature rules, in the order of the collections. On
/// several ranks, each has the dofs of its cells and of their neighbours, and visits its own cells.
template <int dim>
struct LagrangeSpace {
  dealii::hp::FECollection<dim> elements;
  dealii::hp::FECollection<dim> hats;  ///< of degree 1, with one component
  dealii::hp::MappingCollection<dim> mappings;
  dealii::hp::QCollection<dim> rules;
  dealii::hp::QCollection<dim - 1> facet_rules;
  dealii::DoFHandler<dim> dofs;
  dealii::IndexSet relevant_dofs;        ///< this rank's, of its cells and of their neighbours
  std::shared_ptr<const NodeTies> ties;  ///< null: none; always null on several ranks

  /// Distributes the dofs. degree: 1 or 2 on simplices and on planar meshes of both types (deal.II
  /// 9.4 has no others), 1 to 4 on quadrilaterals and hexahedra, 1 on pyramids and prisms.
  /// n_components: of the solution. n_points: Gauss points per direction on cells that are not
  /// simplices; 0: degree + 4. Throws InputError for cells and degrees that deal.II does not have,
  /// such as volume meshes of several types. ties: of degree 1, on one rank. Collective.
  LagrangeSpace(const dealii::Triangulation<dim>& triangulation, unsigned int degree,
                unsigned int n_components, unsigned int n_points,
                std::shared_ptr<const NodeTies> ties = nullptr);

  /// Calls visit(values, cell) for each cell, with its FEValues at the points of its rule: values,
  /// gradients, positions and weights, and what `more` names.
  template <class Visit>
  void for_each_cell(const Visit& visit, dealii::UpdateFlags more = dealii::update_default) const {
    dealii::hp::FEValues<dim> values_of_types(
        mappings, elements, rules,
        more | dealii::update_values | dealii::update_gradients | dealii::update_quadrature_points |
            dealii::update_JxW_values);
    for (const auto& cell : own_cells()) {
      values_of_types.reinit(cell);
      visit(values_of_types.get_present_fe_values(), cell);
    }
  }

  /// Calls visit(cell, cell_matrix, cell_load) for each cell, after integrate(values, cell,
  /// cell_matrix, cell_load) has added the integrals over it to zeros.
  template <class Integrate, class Visit>
  void for_each_integrated_cell(const Integrate& integrate, const Visit& visit,
                                dealii::UpdateFlags more = dealii::update_default) const {
    dealii::FullMatrix<double> cell_matrix;
    dealii::Vector<double> cell_load;
    for_each_cell(
        [&](const dealii::FEValues<dim>& values, const auto& cell) {
          cell_matrix.reinit(values.dofs_per_cell, values.dofs_per_cell);
          cell_load.reinit(values.dofs_per_cell);
          integrate(values, cell, cell_matrix, cell_load);
          visit(cell, cell_matrix, cell_load);
        },
        more);
  }

  /// Adds these integrals to a matrix and a right-hand side with constraints.
  template <class Integrate, class Matrix, class Vector>
  void add_integrals(const Integrate& integrate,
                     const dealii::AffineConstraints<double>& constraints, Matrix& matrix,
                     Vector& right_hand_side,
                     dealii::UpdateFlags more = dealii::update_default) const {
    std::vector<dealii::types::global_dof_index> indices;
    for_each_integrated_cell(
        integrate,
        [&](const auto& cell, const auto& cell_matrix, const auto& cell_load) {
          indices.resize(cell_load.size());
          cell->get_dof_indices(indices);
          constraints.distribute_local_to_global(cell_matrix, cell_load, indices, matrix,
                                                 right_hand_side);
        },
        more);
  }

  /// Calls visit(values, hats, cell) as for_each_cell does, with the FEValues of the hat functions
  /// of the cell's vertices, which map the cell, at the same points.
  template <class Visit>
  void for_each_cell_with_hats(const Visit& visit) const {
    dealii::hp::FEValues<dim> hats_of_types(mappings, hats, rules,
                                            dealii::update_values | dealii::update_gradients);
    for_each_cell([&](const dealii::FEValues<dim>& values, const auto& cell) {
      const unsigned int type = cell->active_fe_index();
      const typename dealii::Triangulation<dim>::cell_iterator of_mesh = cell;
      hats_of_types.reinit(of_mesh, type, type, type);
      visit(values, hats_of_types.get_present_fe_values(), cell);
    });
  }

  /// Calls visit(dof, component) for each dof of each cell, so often more than once for a dof.
  template <class Visit>
  void for_each_dof(const Visit& visit) const {
    std::vector<dealii::types::global_dof_index> indices;
    for (const auto& cell : own_cells()) {
      const auto& element = cell->get_fe();
      indices.resize(element.n_dofs_per_cell());
      cell->get_dof_indices(indices);
      for (unsigned int i = 0; i < indices.size(); ++i)
        visit(indices[i], element.system_to_component_index(i).first);
    }
  }

  /// Returns this rank's cells.
  auto own_cells() const {
    return dofs.active_cell_iterators() | dealii::IteratorFilters::LocallyOwnedCell();
  }

  /// Returns the position of each relevant dof, for the present positions of the vertices.
  std::map<dealii::types::global_dof_index, dealii::Point<dim>> support_points() const;

  /// Constrains the dofs of tied nodes that are not constrained yet.
  void add_ties(dealii::AffineConstraints<double>& constraints) const;

  /// Calls visit(dof, component, boundary id) for each dof of each boundary facet, so often more
  /// than once for a dof. Facets where parts of the mesh are tied are left out. On several ranks,
  /// all boundary facets with a dof of this rank's cells are visited. Facets of other cells may
  /// seem to be on the boundary, but have no such dofs.
  template <class Visit>
  void for_each_boundary_dof(const Visit& visit) const {
    std::vector<dealii::types::global_dof_index> indices;
    for (const auto& cell : dofs.active_cell_iterators())
      for (const unsigned int f : cell->face_indices()) {
        if (cell->is_artificial()) continue;
        const auto face = cell->face(f);
        if (!face->at_boundary() || is_tied(face)) continue;
        const auto& element = cell->get_fe();
        indices.resize(element.n_dofs_per_face(f));
        face->get_dof_indices(indices, cell->active_fe_index());
        for (unsigned int i = 0; i < indices.size(); ++i)
          visit(indices[i], element.face_system_to_component_index(i, f).first,
                face->boundary_id());
      }
  }

  /// True for a facet where parts of the mesh are tied.
  template <class Face>
  bool is_tied(const Face& face) const {
    if (!ties) return false;
    std::vector<NodeIndex> nodes;
    for (const unsigned int v : face->vertex_indices()) nodes.push_back(face->vertex_index(v));
    std::sort(nodes.begin(), nodes.end());
    return ties->inner_facets.contains(nodes);
  }
};

}  // namespace smoothfem
