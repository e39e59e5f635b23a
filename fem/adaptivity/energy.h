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

/// The energy J = a(u_h, u_h) - 2 (f, u_h), a(u, v) = (A grad u, grad v), of solutions on meshes of
/// one topology, and its gradient in node positions. On triangles, quadrilaterals, tetrahedra and
/// hexahedra. f is integrated by rules that each cell gets as fine as it needs: where f is not
/// resolved, J falls by what its quadrature misses, and the error rises. a(u_h, u_h) is integrated
/// as the matrix is. The same bits for every number of threads. Of several ranks each has the terms
/// of its own cells, and the sums over the ranks are what they are on one.
template <int dim>
class Energy {
 public:
  /// The space's cells that are no simplices have a fixed number of points (TensorPoints).
  /// solution: has to outlive this; f and A are taken from it. Throws InputError for pyramids and
  /// prisms, and for A without derivatives. Collective.
  Energy(std::shared_ptr<const FiniteElementSpace<dim>> space,
         const ManufacturedSolution<dim>& solution);

  /// Integrates f over the cells of a mesh, for all that follows. x: coordinates of the space's
  /// nodes.
  void integrate_load(const std::vector<Point<dim>>& x);

  /// b_i += integral of f phi_i, for the free dofs.
  void add_load(Eigen::VectorXd& right_hand_side) const;

  /// Own cells' J of the finite element function with the values u at the dofs, less 2 (f, c) with
  /// the constant c, which is 2 (f, 1) c whatever the mesh is, and keeps J from being a small
  /// difference of large numbers.
  double value(const std::vector<Point<dim>>& x, const Eigen::VectorXd& u, double c) const;

  /// Own cells' dJ / dx_v for the values u of the solution, which stand for themselves: J is
  /// stationary in them. For nodes v inside,
  ///   sum over cells of integrals of -2 (A grad u . grad N_v) grad u
  ///     + (A grad u . grad u) grad N_v + N_v (dA/dx grad u . grad u) + 2 f N_v grad u,
  /// N_v the hat function of the node, with which cells are mapped, and the third term the vector
  /// over the directions of dA/dx_k: A stays where it is, and the cells move through it. (The last
  /// term is that of f u, whose derivative is -2 (N_v u grad f + f u grad N_v), integrated by
  /// parts: no grad f. Of A that would leave jumps of grad u on all facets.) Where A jumps inside
  /// cells J has kinks, of which this does not know.
  std::vector<Point<dim>> gradient(const std::vector<Point<dim>>& x,
                                   const Eigen::VectorXd& u) const;

 private:
  /// What integrate_load leaves of the cells of one element.
  struct GroupLoad {
    EnergyRules rules;
    std::vector<std::uint8_t> levels;  ///< the rule of each cell
    std::vector<double> values;        ///< of f phi_i: n_cells x n_dofs
    /// For parts of the cells: f times the weight of each point, cell after cell.
    std::vector<std::vector<double>> weighted_f;
  };

  /// Of a(u_h, u_h).
  template <std::size_t n_dofs, std::size_t n_vertices>
  const QuadratureTable& gradient_rule(const ElementCells& group, const EnergyRules& rules) const;

  /// To the derivatives of the cells of a part: those of f u.
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
