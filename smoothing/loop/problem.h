// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Cost of all solves of one solver so far.
struct SolveEffort {
  std::size_t n_solves = 0;
  double seconds = 0.0;
};

/// Symmetric tensor of one cell.
template <int dim>
using CellTensor = Eigen::Matrix<double, dim, dim>;

/// Solves a boundary value problem on the meshes of a solution-adaptive method, which moves nodes
/// by its solution u_h. This is an interface only; the finite element library implements it.
/// Results are bitwise identical for every number of threads.
template <int dim>
class ProblemSolver {
 public:
  virtual ~ProblemSolver() = default;

  /// Prepares solves on meshes of this topology with elements of this degree (1 or 2). Call it
  /// before the first solve; a second call with the same arguments costs nothing. Throws InputError
  /// if the problem cannot be solved on the mesh.
  virtual void prepare(const Mesh<dim>& mesh, int degree) = 0;

  /// False if the problem has indicators only. `solve` then returns 0.
  virtual bool has_energy() const { return true; }

  /// Solves on a mesh whose cells are all valid; a second solve on the same mesh costs nothing.
  /// Returns the energy J = a(u_h, u_h) - 2 (f, u_h) up to a constant, with a(v, v) = |grad v|^2 if
  /// the operator is -laplace. If boundary nodes stay, a(u - u_h, u - u_h) = J + const. Returns
  /// infinity if there is no solution, for example on hexahedra that are folded inside; the
  /// functions below must not be called then.
  virtual double solve(std::span<const Point<dim>> coordinates) = 0;

  /// Returns dJ / dx_i of the last solve for each node i; zero for fixed nodes.
  virtual std::vector<Point<dim>> energy_gradient() const = 0;

  /// Returns one number for each cell, of the last solve: the root mean square, in the norm of a,
  /// of the difference between grad u_h and a continuous gradient. That gradient is recovered from
  /// grad u_h by averages at the nodes (Zienkiewicz, Zhu 1987).
  virtual std::vector<double> recovery_indicators() const = 0;

  /// Returns for each cell the mean of d d^T, where d is that difference: the directions of the
  /// gradient's error. The trace is the square of the indicator.
  virtual std::vector<CellTensor<dim>> recovery_tensors() const = 0;

  /// Returns for each cell its share of the residual error estimate with the jumps of the gradient
  /// across facets (Kelly et al. 1983), divided by the square root of its size; of the last solve.
  /// Like the recovery indicator it is a mean over the cell, up to a constant.
  virtual std::vector<double> residual_indicators() const = 0;

  /// Returns for each cell the mean of the symmetric derivative of that continuous gradient: the
  /// second derivatives of the solution.
  virtual std::vector<CellTensor<dim>> recovered_hessians() const = 0;

  virtual SolveEffort effort() const = 0;
};

/// A boundary value problem on the domain of a mesh.
template <int dim>
class Problem {
 public:
  virtual ~Problem() = default;
  virtual std::unique_ptr<ProblemSolver<dim>> make_solver() const = 0;
};

}  // namespace smoothfem
