// SPDX-License-Identifier: GPL-3.0-or-later
#include "python/module/bind.h"
#include "python/module/interruptible.h"
#include "python/module/python_smoother.h"
#include "python/module/python_solver.h"
#include "smoothing/base/input_error.h"
#include "smoothing/base/interruption.h"
#include "smoothing/base/option_text.h"
#include "smoothing/base/text.h"
#include "smoothing/loop/python_methods.h"

PYBIND11_MODULE(_core, module) {
  module.doc() = "The compiled part of smoothfem.";
  module.attr("__version__") = SMOOTHFEM_VERSION;
  pybind11::register_exception<smoothfem::InputError>(module, "InputError", PyExc_ValueError);
  smoothfem::bind_mesh(module);
  smoothfem::bind_files(module);
  smoothfem::bind_grids(module);
  smoothfem::bind_smoothing(module);
  smoothfem::bind_solving(module);
  // Names of files in messages may have bytes that are not Unicode.
  pybind11::register_exception_translator([](std::exception_ptr error) {
    try {
      std::rethrow_exception(error);
    } catch (const smoothfem::InputError& input_error) {
      const auto type = pybind11::module_::import("smoothfem._core").attr("InputError");
      PyErr_SetString(type.ptr(), smoothfem::as_utf8(input_error.what()).c_str());
    }
  });
  // A program that has started the interpreter has its own handlers.
  if (!smoothfem::started_python()) {
    smoothfem::interruption_hook() = smoothfem::ask_python_for_signals;
    smoothfem::options_are_arguments() = true;
  }
  smoothfem::set_python_methods(smoothfem::make_python_method);
  smoothfem::set_python_solvers(smoothfem::make_python_solver);
}
