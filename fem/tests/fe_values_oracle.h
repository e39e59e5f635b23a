// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Reference implementation for the kernels: deal.II's FEValues with deal.II's numbering.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/vector_tools.h>

#include <memory>
#include <stdexcept>

#include "fem/deal_ii/solution_functions.h"

namespace smoothfem {

/// The rules for matrices and for errors. On simplices the rule for matrices differs from that of
/// smoothfem: any exact rule will do.
template <int dim>
dealii::Quadrature<dim> oracle_rule(bool simplices, unsigned int degree, bool errors) {
  dealii::Quadrature<dim> rule;
  if (!simplices)
    rule = dealii::QGauss<dim>(dim == 2 ? 8 : 4);
  else if (dim == 2)
    rule = dealii::QWitherdenVincentSimplex<dim>(errors ? 6 : 5);
  else
    rule = dealii::QWitherdenVincentSimplex<dim>(!errors ? 5 : degree == 1 ? 3 : 4);
  // For unknown degrees deal.II returns empty rules, in Release without an error.
  if (rule.size() == 0) throw std::logic_error("empty quadrature rule");
  return rule;
}

/// A mesh of only simplices or only tensor cells, with its dofs.
template <int dim>
class Oracle {
 public:
  Oracle(const Mesh<dim>& mesh, unsigned int degree)
      : simplices_(mesh.topology().cell_nodes(0).size() == dim + 1), degree_(degree) {
    fill_triangulation(mesh);
    if (simplices_) {
      element_ = std::make_unique<dealii::FE_SimplexP<dim>>(degree);
      mapping_ = std::make_unique<dealii::MappingFE<dim>>(dealii::FE_SimplexP<dim>(1));
    } else {
      element_ = std::make_unique<dealii::FE_Q<dim>>(degree);
      mapping_ = std::make_unique<dealii::MappingQ<dim>>(1);
    }
    dofs_.reinit(triangulation_);
    dofs_.distribute_dofs(*element_);
  }

  bool simplices() const { return simplices_; }
  const dealii::DoFHandler<dim>& dofs() const { return dofs_; }
  std::vector<Point<dim>> dof_points() const {
    std::vector<dealii::Point<dim>> positions(dofs_.n_dofs());
    dealii::DoFTools::map_dofs_to_support_points(*mapping_, dofs_, positions);
    std::vector<Point<dim>> points;
    for (const auto& p : positions) points.push_back(point_from(p));
    return points;
  }

  /// Calls visit(values on a cell, numbers of its dofs) for each cell.
  template <class Visit>
  void for_each_cell(const dealii::Quadrature<dim>& rule, const Visit& visit) const {
    dealii::FEValues<dim> values(*mapping_, *element_, rule,
                                 dealii::update_values | dealii::update_gradients |
                                     dealii::update_quadrature_points | dealii::update_JxW_values);
    std::vector<dealii::types::global_dof_index> indices(element_->n_dofs_per_cell());
    for (const auto& cell : dofs_.active_cell_iterators()) {
      values.reinit(cell);
      cell->get_dof_indices(indices);
      visit(values, indices);
    }
  }
  template <class Visit>
  void for_each_cell(const Visit& visit) const {
    for_each_cell(oracle_rule<dim>(simplices_, degree_, false), visit);
  }

  /// Norm of u - u_h, with u_h from its values at the dofs.
  double error(const ManufacturedSolution<dim>& solution, const dealii::Vector<double>& discrete,
               dealii::VectorTools::NormType norm) const {
    dealii::Vector<double> of_cells(triangulation_.n_active_cells());
    dealii::VectorTools::integrate_difference(*mapping_, dofs_, discrete,
                                              SolutionFunction<dim>(solution), of_cells,
                                              oracle_rule<dim>(simplices_, degree_, true), norm);
    return dealii::VectorTools::compute_global_error(triangulation_, of_cells, norm);
  }

 private:
  void fill_triangulation(const Mesh<dim>& mesh) {
    std::vector<dealii::Point<dim>> vertices;
    for (const auto& p : mesh.coordinates()) {
      vertices.emplace_back();
      for (int d = 0; d < dim; ++d) vertices.back()[d] = p[d];
    }
    constexpr std::array<unsigned int, 8> lexicographic{0, 1, 3, 2, 4, 5, 7, 6};
    std::vector<dealii::CellData<dim>> cells;
    for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
      const auto nodes = mesh.topology().cell_nodes(c);
      cells.emplace_back(static_cast<unsigned int>(nodes.size()));
      for (std::size_t k = 0; k < nodes.size(); ++k)
        cells.back().vertices[k] = nodes[simplices_ ? k : lexicographic[k]];
    }
    triangulation_.create_triangulation(vertices, cells, dealii::SubCellData());
  }

  bool simplices_;
  unsigned int degree_;
  dealii::Triangulation<dim> triangulation_;
  std::unique_ptr<dealii::FiniteElement<dim>> element_;
  std::unique_ptr<dealii::Mapping<dim>> mapping_;
  dealii::DoFHandler<dim> dofs_;
};

}  // namespace smoothfem
