// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "smoothing/loop/problem.h"

namespace smoothfem {

/// Solver for several problems with solutions u_k on one mesh. The energy is the sum of w_k J_k.
/// Gradients and error tensors are sums with the same weights. Indicators are square roots of such
/// sums of squares. Second derivatives are the roots of such sums of H_k^2; sums of the H_k
/// themselves could cancel where all u_k bend.
///
/// w_k is a constant over e_k^2, the squared error that the recovery estimates on the first mesh
/// that is solved on. So the sum of the relative squared errors falls, and no problem counts for
/// more because its solution or its error is larger. On that mesh the gradient is that of the
/// product of all e_k^2, and so of their geometric mean. Problems without an error there (solutions
/// in the space) have the weight 0. The weights stay while topology and degree do: all stages of a
/// method have one objective.
///
/// Each evaluation counts as one solve for each problem. For a single problem it equals that
/// problem's solver. solvers: at least one.
template <int dim>
std::unique_ptr<ProblemSolver<dim>> combined_solver(
    std::vector<std::unique_ptr<ProblemSolver<dim>>> solvers);

}  // namespace smoothfem
