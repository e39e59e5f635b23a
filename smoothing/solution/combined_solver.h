// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "smoothing/loop/problem.h"

namespace smoothfem {

/// One mesh for the solutions u_k of several problems on it: the energy is the sum of w_k J_k, and
/// what else methods ask for follows: gradients and error tensors are sums with the same weights,
/// indicators the roots of such sums of squares, and second derivatives the roots of such sums of
/// H_k^2 (the sums of the H_k themselves could cancel where all u_k bend).
///
/// w_k is a constant over e_k^2, the squared error that the recovery estimates on the first mesh
/// that is solved on: what falls is the sum of the relative squared errors, in which no problem
/// counts for more because its solution or its error is larger. On that mesh its gradient is that
/// of the product of all e_k^2, and so of their geometric mean. Problems without an error there,
/// whose solutions are in the space, have the weight 0. The weights stay as long as topology and
/// degree do: one function for all stages of a method.
///
/// Each evaluation counts as many solves as there are problems. Of one problem it is that solver
/// itself. solvers: at least one.
template <int dim>
std::unique_ptr<ProblemSolver<dim>> combined_solver(
    std::vector<std::unique_ptr<ProblemSolver<dim>>> solvers);

}  // namespace smoothfem
