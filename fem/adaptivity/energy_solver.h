// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fem/solutions/manufactured_solution.h"
#include "fem/space/finite_element_space.h"

namespace smoothfem {

/// A finite element function on an undivided mesh, on one process.
template <int dim>
struct GatheredFunction {
  const FiniteElementSpace<dim>& space;
  const std::vector<Point<dim>>& x;  ///< of the space's nodes
  const Eigen::VectorXd& u;          ///< at the space's dofs
};

/// Solves -div(A grad u) = f on meshes of one topology. Computes the energy J = a(u_h, u_h) - 2 (f,
/// u_h) and its gradient in node positions (see Energy). Planar meshes on one process use a
/// Cholesky factorization, all others CG with algebraic multigrid. Both errors are far below the
/// discretization error. Cells of second order are straight-sided here: the energy and its gradient
/// are those of the mesh of their corners.
template <int dim>
class EnergySolver {
 public:
  virtual ~EnergySolver() = default;

  /// Solves on a mesh. coordinates: of all nodes of a mesh of the topology with valid cells.
  /// Returns J, up to a constant. Returns infinity if there is no solution, for example on
  /// hexahedra that are folded inside; the functions below must not be called then.
  virtual double solve(std::span<const Point<dim>> coordinates) = 0;

  /// Returns the gradient for each node of the mesh, of the last solve. Meaningful if the boundary
  /// does not move.
  virtual std::vector<Point<dim>> gradient() = 0;

  /// Returns u_h of the last solve. It refers to this solver and is valid until its next solve.
  virtual GatheredFunction<dim> function() = 0;
};

/// Makes an energy solver. mesh: any mesh of the topology, on the root; null elsewhere. solution:
/// must outlive the solver. natural_groups: see make_finite_element_space.
///
/// Several ranks share the work of solves and gradients. All calls are then collective, with
/// coordinates and results on the root (J on all ranks). `function` gathers u_h on the root, which
/// alone may read it. Throws InputError on all ranks, as make_finite_element_space and Energy do.
template <int dim>
std::unique_ptr<EnergySolver<dim>> make_energy_solver(
    const Mesh<dim>* mesh, int degree, const ManufacturedSolution<dim>& solution,
    const std::vector<std::string>& natural_groups = {}, const Ranks& ranks = {});

}  // namespace smoothfem
