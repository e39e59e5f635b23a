// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fem/solutions/manufactured_solution.h"
#include "fem/space/finite_element_space.h"

namespace smoothfem {

/// A finite element function on a whole mesh, as one process has it.
template <int dim>
struct WholeFunction {
  const FiniteElementSpace<dim>& space;
  const std::vector<Point<dim>>& x;  ///< of the space's nodes
  const Eigen::VectorXd& u;          ///< at the space's dofs
};

/// Solves -div(A grad u) = f on meshes of one topology for the energy J = a(u_h, u_h) - 2 (f, u_h)
/// and its gradient in node positions (see Energy): planar meshes by a Cholesky factorization on
/// one process, all others by CG with algebraic multigrid, both far below the error.
template <int dim>
class EnergySolver {
 public:
  virtual ~EnergySolver() = default;

  /// coordinates: of all nodes of a mesh of the topology, all of whose cells are valid. Returns J,
  /// up to a constant; infinity if there is no solution, as on hexahedra that are folded inside:
  /// what follows must not be asked for then.
  virtual double solve(std::span<const Point<dim>> coordinates) = 0;

  /// Of each node of the mesh, for the last solve; of use where the boundary does not move with it.
  virtual std::vector<Point<dim>> gradient() = 0;

  /// u_h of the last solve. It refers to this solver, until its next solve.
  virtual WholeFunction<dim> function() = 0;
};

/// mesh: any mesh of the topology, on the root; null elsewhere. Several ranks share the work of
/// solves and gradients: all calls are collective then, with coordinates on the root and with
/// results there (J on all ranks); `function`, which the root alone may look at, brings u_h to it.
/// solution: has to outlive the solver. natural_groups: see make_finite_element_space. Throws
/// InputError on all ranks as that does, and as Energy does.
template <int dim>
std::unique_ptr<EnergySolver<dim>> make_energy_solver(
    const Mesh<dim>* mesh, int degree, const ManufacturedSolution<dim>& solution,
    const std::vector<std::string>& natural_groups = {}, const Ranks& ranks = {});

}  // namespace smoothfem
