// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

/// The parts of the extension module smoothfem._core. Docstrings for users are those of the package
/// (python/smoothfem): the functions bound here take their arguments unchecked.
namespace smoothfem {

void bind_mesh(pybind11::module_& module);
void bind_files(pybind11::module_& module);  ///< reads, writes, generates, distorts, measures
void bind_grids(pybind11::module_& module);  ///< to and from objects of other packages
void bind_smoothing(pybind11::module_& module);
void bind_solving(pybind11::module_& module);

}  // namespace smoothfem
