// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

#include "smoothing/loop/method_scheme.h"

namespace smoothfem {

/// The method that a class in a Python file is. The GIL need not be held. Throws InputError that
/// names file and line if the file cannot be run, or if the class is not a smoother.
MethodEntry make_python_method(const MethodInFile& method);

/// The method of a smoother's definition (python/smoothfem/_smoothers.py). The GIL must be held.
MethodEntry method_of_definition(const pybind11::object& definition);

}  // namespace smoothfem
