// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/solutions/manufactured_solution.h"

namespace smoothfem::bench {

/// Seconds of the parts of one solution, on one process.
struct StockTimes {
  double assembly = 0.0, cg = 0.0, errors = 0.0;
  unsigned int cg_iterations = 0;
  double l2_error = 0.0;

  double seconds() const { return assembly + cg + errors; }
};

/// Solves in the way of deal.II's tutorials: FEValues, AffineConstraints, SparseMatrix, SolverCG
/// without preconditioner, VectorTools::integrate_difference. Numbering and sparsity pattern are
/// not timed.
StockTimes solve_by_stock_path(const VolumeMesh& mesh, int degree,
                               const ManufacturedSolution<3>& solution, double tolerance);

}  // namespace smoothfem::bench
