// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "fem/solutions/manufactured_solution.h"
#include "fem/space/finite_element_space.h"
#include "smoothing/loop/problem.h"

namespace smoothfem {

/// Computes the energy J = a(u_h, u_h) - 2 (f, u_h) of solutions on meshes of one topology, and its
/// gradient in node positions. a(u, v) = (A grad u, grad v). For triangles, quadrilaterals,
/// tetrahedra and hexahedra.
///
/// f is integrated by rules that are as fine as each cell needs. If f is not resolved, J falls by
/// the missing part of its quadrature while the error rises. a(u_h, u_h) is integrated like the
/// matrix. Results are bitwise identical for every number of threads. Each of several ranks has the
/// terms of its own cells; the sums over the ranks equal those of a single rank.
template <int dim>
class Energy {
 public:
  /// Cells of the space that are not simplices have a fixed number of points (TensorPoints).
  /// solution: provides f and A; must outlive this. Throws InputError for pyramids and prisms, and
  /// for A without derivatives. Collective.
  Energy(std::shared_ptr<const FiniteElementSpace<dim>> space,
         const ManufacturedSolution<dim>& solution);

  /// Integrates f over the cells of a mesh, for all later calls. x: coordinates of the space's
  /// nodes.
  void integrate_load(const std::vector<Point<dim>>& x);

  /// Computes b_i += integral of f phi_i for the free dofs.
  void add_load(Eigen::VectorXd& right_hand_side) const;

  /// Returns the own cells' J of the finite element function with the values u at the dofs, less 2
  /// (f, c) with the constant c. That term is 2 (f, 1) c on every mesh; leaving it out keeps J from
  /// being a small difference of large numbers.
  double value(const std::vector<Point<dim>>& x, const Eigen::VectorXd& u, double c) const;

  /// Returns the own cells' dJ / dx_v for the values u of the solution. J is stationary in u, so
  /// that derivatives of u drop out. For inner nodes v:
  ///
  ///   sum over cells of integrals of -2 (A grad u . grad N_v) grad u
  ///     + (A grad u . grad u) grad N_v + N_v (dA/dx grad u . grad u) + 2 f N_v grad u.
  ///
  /// N_v is the hat function of the node, which maps the cells. The third term is the vector over
  /// the directions of dA/dx_k: A is fixed in space, and the cells move through it. The last term
  /// comes from f u; its derivative -2 (N_v u grad f + f u grad N_v) is integrated by parts to
  /// avoid grad f. (For A this would leave jumps of grad u on all facets.) If A jumps inside cells,
  /// J has kinks, which this gradient ignores.
  std::vector<Point<dim>> gradient(const std::vector<Point<dim>>& x,
                                   const Eigen::VectorXd& u) const;

 private:
  /// Result of integrate_load for the cells of one element.
  struct GroupLoad {
    EnergyRules rules;
    std::vector<std::uint8_t> levels;  ///< the rule of each cell
    std::vector<double> values;        ///< of f phi_i: n_cells x n_dofs
    /// For parts of the cells: f times the weight of each point, cell after cell.
    std::vector<std::vector<double>> weighted_f;
  };

  /// Adds the derivatives of a(u_h, u_h).
  template <std::size_t n_dofs, std::size_t n_vertices>
  const QuadratureTable& gradient_rule(const ElementCells& group, const EnergyRules& rules) const;

  /// Adds the derivatives of f u to those of the cells of a part.
  template <std::size_t n_dofs, std::size_t n_vertices>
  void add_load_terms(const ElementCells& group, const GroupLoad& load, std::size_t part,
                      const std::vector<std::size_t>& cells, const std::vector<Point<dim>>& x,
                      const Eigen::VectorXd& u,
                      std::vector<std::array<Point<dim>, n_vertices>>& of_cells) const;

  std::shared_ptr<const FiniteElementSpace<dim>> space_;
  const ManufacturedSolution<dim>& solution_;
  std::vector<GroupLoad> loads_;
};

}  // namespace smoothfem
