// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/loop/method_scheme.h"

namespace smoothfem {

/// Smoothers written in Python are methods named "python:FILE:CLASS". This library knows no Python:
/// what makes them is the Python module smoothfem (folder python/), which says so here as an
/// interpreter loads it. In a program without an interpreter the first such name starts one, by
/// libsmoothfem_python_host.so.
void set_python_methods(MethodEntry (*make)(const MethodInFile& method));

/// True if this program has started the interpreter, false if Python has started this library.
bool started_python();

}  // namespace smoothfem
