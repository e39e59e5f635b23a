// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/solvers/python_solvers.h"

namespace smoothfem {

/// The solver that a class in a Python file is. The GIL need not be held. Throws InputError that
/// names file and line if the file cannot be run, or if the class is not a solver.
SolverMakers make_python_solver(const MethodInFile& solver);

}  // namespace smoothfem
