// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// What the solves of one solver have cost so far.
struct SolveEffort {
  std::size_t n_solves = 0;
  double seconds = 0.0;
};

/// Symmetric.
template <int dim>
using CellTensor = Eigen::Matrix<double, dim, dim>;

/// Solves a boundary value problem on the meshes that a method goes through, for methods that move
/// nodes by its solution u_h. Here an interface only: who implements it knows finite elements. The
/// same bits for every number of threads.
template <int dim>
class ProblemSolver {
 public:
  virtual ~ProblemSolver() = default;

  /// Called before the first solve on meshes of this topology, by elements of this degree (1 or 2);
  /// a second call with the same costs nothing. Throws InputError if the problem cannot be solved
  /// on it.
  virtual void prepare(const Mesh<dim>& mesh, int degree) = 0;

  /// Solves on a mesh whose cells are all valid; on that of the last solve it costs nothing.
  /// Returns the energy J = a(u_h, u_h) - 2 (f, u_h) up to a constant: as long as boundary nodes
  /// stay, a(u - u_h, u - u_h) = J + const; with -laplace as the operator a(v, v) = |grad v|^2.
  /// Infinite if there is no solution, as on hexahedra that
  /// are folded inside; what follows must not be asked for then.
  virtual double solve(std::span<const Point<dim>> coordinates) = 0;

  /// dJ / dx_i of the last solve for each node i; zero for fixed nodes.
  virtual std::vector<Point<dim>> energy_gradient() const = 0;

  /// Root mean square over each cell of the difference between grad u_h and the continuous gradient
  /// that is recovered from it by averages at the nodes (Zienkiewicz, Zhu 1987), in the norm of a;
  /// of the last solve.
  virtual std::vector<double> recovery_indicators() const = 0;

  /// Mean over each cell of d d^T, where d is that difference: into which directions the gradient
  /// errs. The trace is the square of the indicator.
  virtual std::vector<CellTensor<dim>> recovery_tensors() const = 0;

  /// Of each cell: its share of the estimate of the error by the residual, with the jumps of the
  /// gradient across its facets (Kelly et al. 1983), divided by the square root of its size; of
  /// the last solve. A mean over the cell as the indicator of the recovery is, up to a constant.
  virtual std::vector<double> residual_indicators() const = 0;

  /// Mean over each cell of the symmetric derivative of that continuous gradient: the solution's
  /// second derivatives.
  virtual std::vector<CellTensor<dim>> recovered_hessians() const = 0;

  virtual SolveEffort effort() const = 0;
};

/// A boundary value problem on the domain that is meshed.
template <int dim>
class Problem {
 public:
  virtual ~Problem() = default;
  virtual std::unique_ptr<ProblemSolver<dim>> make_solver() const = 0;
};

}  // namespace smoothfem
