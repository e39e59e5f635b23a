// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/solvers/mesh_solver.h"
#include "smoothing/loop/method_in_file.h"

namespace smoothfem {

/// Sets the function that makes the solvers named "python:FILE:CLASS" (see set_python_methods).
void set_python_solvers(SolverMakers (*make)(const MethodInFile& solver));

}  // namespace smoothfem
