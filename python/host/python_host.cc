// SPDX-License-Identifier: GPL-3.0-or-later
#include <dlfcn.h>
#include <pybind11/embed.h>

#include <csignal>
#include <filesystem>
#include <string>

/// Starts Python in a program that has none, for smoothers written in it. A library of its own, so
/// that who has no such smoother needs no libpython (smoothing/loop/python_methods.h loads it).

namespace {

namespace fs = std::filesystem;
namespace py = pybind11;

/// The folder of the package smoothfem: below that of this library or one above, as modules of the
/// system's python3 lie.
fs::path package_folder() {
  Dl_info library{};
  dladdr(reinterpret_cast<const void*>(&package_folder), &library);
  const fs::path own = fs::weakly_canonical(library.dli_fname ? library.dli_fname : "");
  for (fs::path above = own.parent_path(); above.has_relative_path(); above = above.parent_path())
    if (const fs::path folder = above / "python3" / "dist-packages";
        fs::exists(folder / "smoothfem" / "__init__.py"))
      return folder;
  return {};
}

/// Handlers of the program, by signal; null if the program has none.
void (*program_handlers[NSIG])(int) = {};

/// Interrupts a step that is in Python's hands by KeyboardInterrupt, and tells the program.
void on_interrupt(int signal) {
  PyErr_SetInterrupt();
  program_handlers[signal](signal);
}

/// Python has its own handler for Ctrl-C. The program's comes first again.
void share_signals(int signal, const struct sigaction& of_program) {
  struct sigaction shared = of_program;
  if (of_program.sa_handler != SIG_DFL && of_program.sa_handler != SIG_IGN) {
    program_handlers[signal] = of_program.sa_handler;
    shared.sa_handler = on_interrupt;
  }
  sigaction(signal, &shared, nullptr);
}

/// As the python3 that this was compiled for would start, but Ctrl-C stays the program's.
PyStatus start_interpreter() {
  PyConfig config;
  PyConfig_InitPythonConfig(&config);
  config.install_signal_handlers = 0;
  config.parse_argv = 0;
  config.write_bytecode = 0;  // in the folder of an installation there is nothing to write
  PyStatus status =
      PyConfig_SetBytesString(&config, &config.program_name, SMOOTHFEM_PYTHON_EXECUTABLE);
  if (!PyStatus_Exception(status)) status = Py_InitializeFromConfig(&config);
  PyConfig_Clear(&config);
  return status;
}

/// Loads numpy, which all methods need, and the package, which makes the methods known. Its folder
/// comes first for that moment only.
void import_package(const std::string& folder) {
  py::module_::import("numpy");
  auto path = py::module_::import("sys").attr("path");
  path.attr("insert")(0, folder);
  py::module_::import("smoothfem");
  path.attr("remove")(folder);
  path.attr("append")(folder);
}

}  // namespace

/// Null, or why Python cannot be started. Call it once, on the main thread; any thread may use
/// Python then, each with the GIL.
extern "C" const char* smoothfem_start_python() {
  static std::string why_not;
  const fs::path folder = package_folder();
  if (folder.empty()) return "the Python package smoothfem is missing; install smoothfem anew";
  if (Py_IsInitialized() == 0) {
    struct sigaction interrupt {
    }, terminate{};
    sigaction(SIGINT, nullptr, &interrupt);
    sigaction(SIGTERM, nullptr, &terminate);
    if (const PyStatus status = start_interpreter(); PyStatus_Exception(status)) {
      why_not = status.err_msg ? status.err_msg : "the interpreter has ended at once";
      return why_not.c_str();
    }
    try {
      import_package(folder.string());
      const py::module_ signals = py::module_::import("signal");
      signals.attr("signal")(SIGINT, signals.attr("default_int_handler"));
      share_signals(SIGINT, interrupt);
      share_signals(SIGTERM, terminate);
    } catch (const py::error_already_set& error) {
      why_not = py::cast<std::string>(py::str(error.value()));
      why_not = why_not.substr(0, why_not.find('\n')) +
                "; methods in Python need numpy, on Debian: apt install python3-numpy";
    }
    PyEval_SaveThread();
  }
  return why_not.empty() ? nullptr : why_not.c_str();
}
