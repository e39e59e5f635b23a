// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/loop/method_scheme.h"
#include "smoothing/loop/python_interpreter.h"

namespace smoothfem {

/// Sets the function that makes the methods named "python:FILE:CLASS", which are smoothers written
/// in Python. This library does not link Python: the Python module smoothfem (folder python/) calls
/// this function when an interpreter loads it. In a program without an interpreter the first such
/// name starts one, by libsmoothfem_python_host.so.
void set_python_methods(MethodEntry (*make)(const MethodInFile& method));

}  // namespace smoothfem
