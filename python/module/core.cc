// SPDX-License-Identifier: GPL-3.0-or-later
#include "python/module/bind.h"
#include "python/module/python_smoother.h"
#include "smoothing/base/input_error.h"
#include "smoothing/loop/python_methods.h"

PYBIND11_MODULE(_core, module) {
  module.doc() = "The compiled part of smoothfem.";
  pybind11::register_exception<smoothfem::InputError>(module, "InputError", PyExc_ValueError);
  smoothfem::bind_mesh(module);
  smoothfem::bind_files(module);
  smoothfem::bind_smoothing(module);
  smoothfem::bind_solving(module);
  smoothfem::set_python_methods(smoothfem::make_python_method);
}
