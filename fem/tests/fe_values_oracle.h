// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Reference implementation for the kernels: deal.II's FEValues with deal.II's numbering.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/fe/mapping_fe_field.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/vector_tools.h>

#include <memory>
#include <stdexcept>

#include "fem/deal_ii/solution_functions.h"
#include "smoothing/mesh/volume_elements.h"

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
    element_ = lagrange(degree);
    if (simplices_)
      mapping_ = std::make_unique<dealii::MappingFE<dim>>(dealii::FE_SimplexP<dim>(1));
    else
      mapping_ = std::make_unique<dealii::MappingQ<dim>>(1);
    dofs_.reinit(triangulation_);
    dofs_.distribute_dofs(*element_);
  }

  /// Maps the cells by their midside nodes, too: those of TRI6, QUAD9, TET10 or HEX27.
  void use_midside_nodes(const Mesh<dim>& mesh) {
    const auto quadratic = lagrange(2);
    position_dofs_.reinit(triangulation_);
    position_dofs_.distribute_dofs(dealii::FESystem<dim>(*quadratic, dim));
    const auto& element = position_dofs_.get_fe();
    positions_.reinit(position_dofs_.n_dofs());
    const auto places = reference_points(mesh.topology().cell_nodes(0).size());
    std::vector<dealii::types::global_dof_index> indices(element.n_dofs_per_cell());
    for (const auto& cell : position_dofs_.active_cell_iterators()) {
      const CellIndex c = cell->active_cell_index();
      std::vector<NodeIndex> nodes(mesh.topology().cell_nodes(c).begin(),
                                   mesh.topology().cell_nodes(c).end());
      nodes.insert(nodes.end(), mesh.topology().midside_nodes(c).begin(),
                   mesh.topology().midside_nodes(c).end());
      cell->get_dof_indices(indices);
      for (unsigned int i = 0; i < indices.size(); ++i) {
        const auto [direction, k] = element.system_to_component_index(i);
        for (std::size_t n = 0; n < nodes.size(); ++n)
          if (places[n].distance(quadratic->unit_support_point(k)) < 1e-12)
            positions_[indices[i]] = mesh.coordinates()[nodes[n]][static_cast<int>(direction)];
      }
    }
    mapping_ = std::make_unique<dealii::MappingFEField<dim>>(position_dofs_, positions_);
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
    return error(solution, discrete, norm, oracle_rule<dim>(simplices_, degree_, true));
  }
  double error(const ManufacturedSolution<dim>& solution, const dealii::Vector<double>& discrete,
               dealii::VectorTools::NormType norm, const dealii::Quadrature<dim>& rule) const {
    dealii::Vector<double> of_cells(triangulation_.n_active_cells());
    dealii::VectorTools::integrate_difference(
        *mapping_, dofs_, discrete, SolutionFunction<dim>(solution), of_cells, rule, norm);
    return dealii::VectorTools::compute_global_error(triangulation_, of_cells, norm);
  }

 private:
  static constexpr std::array<std::size_t, 8> lexicographic{0, 1, 3, 2, 4, 5, 7, 6};

  std::unique_ptr<dealii::FiniteElement<dim>> lagrange(unsigned int degree) const {
    if (simplices_) return std::make_unique<dealii::FE_SimplexP<dim>>(degree);
    return std::make_unique<dealii::FE_Q<dim>>(degree);
  }

  /// Returns the reference points of a cell's corners and midside nodes, in the mesh's order.
  std::vector<dealii::Point<dim>> reference_points(std::size_t n_corners) const {
    const auto linear = lagrange(1);
    std::vector<dealii::Point<dim>> points;
    for (std::size_t k = 0; k < n_corners; ++k)
      points.push_back(
          linear->unit_support_point(static_cast<unsigned int>(simplices_ ? k : lexicographic[k])));
    const auto add_mean = [&](const std::vector<std::size_t>& corners) {
      dealii::Point<dim> mean;
      for (const std::size_t k : corners) mean += points[k] / static_cast<double>(corners.size());
      points.push_back(mean);
    };
    for_each_edge(dim, n_corners, [&](std::size_t a, std::size_t b) { add_mean({a, b}); });
    if (simplices_) return points;
    if (dim == 3)
      for_each_quadrilateral_face(n_corners, [&](const LocalFace& face) {
        add_mean({face.nodes.begin(), face.nodes.end()});
      });
    std::vector<std::size_t> all;
    for (std::size_t k = 0; k < n_corners; ++k) all.push_back(k);
    add_mean(all);
    return points;
  }

  void fill_triangulation(const Mesh<dim>& mesh) {
    std::vector<dealii::Point<dim>> vertices;
    for (const auto& p : mesh.coordinates()) {
      vertices.emplace_back();
      for (int d = 0; d < dim; ++d) vertices.back()[d] = p[d];
    }
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
  dealii::DoFHandler<dim> position_dofs_;
  dealii::Vector<double> positions_;
  std::unique_ptr<dealii::Mapping<dim>> mapping_;
  dealii::DoFHandler<dim> dofs_;
};

}  // namespace smoothfem
