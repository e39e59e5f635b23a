// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "python/module/python_mesh.h"
#include "smoothing/base/interruption.h"
#include "smoothing/loop/parameter.h"
#include "smoothing/loop/python_methods.h"
#include "smoothing/loop/smoother.h"

namespace smoothfem {

/// A text of Python's, which may have parts that are not Unicode.
inline std::string utf8(const py::handle& text) {
  return py::cast<std::string>(py::str(text).attr("encode")("utf-8", "replace"));
}

/// Keeps what a user's code may change in a program that has started the interpreter: the current
/// folder, and that there is one process.
class AsBefore {
 public:
  AsBefore() : folder_(std::filesystem::current_path(ignored_)) {}
  ~AsBefore() {
    if (!started_python()) return;
    if (::getpid() != process_) ::_exit(0);  // a copy by fork, which must not write results, too
    if (std::filesystem::current_path(ignored_) != folder_)
      std::filesystem::current_path(folder_, ignored_);
  }
  AsBefore(const AsBefore&) = delete;

 private:
  std::error_code ignored_;
  std::filesystem::path folder_;
  pid_t process_ = ::getpid();
};

/// Runs Python. Its helpers make InputErrors of what a user's classes do wrong; a program that has
/// started the interpreter knows no other exceptions of Python's, but in Python they keep what they
/// know besides, and Ctrl-C is passed on.
template <class Call>
decltype(auto) with_python(const Call& call) {
  const py::gil_scoped_acquire gil;
  const AsBefore as_before;
  try {
    return call();
  } catch (const py::error_already_set& error) {
    if (!started_python()) throw;
    if (interruption()) throw Interrupted{};
    throw SmootherFailure(error.matches(PyExc_KeyboardInterrupt)
                              ? "its code in Python has raised KeyboardInterrupt"
                              : utf8(error.value()));
  }
}

/// Objects of Python that are let go of with the GIL held.
struct PythonObjects {
  py::object definition;                     ///< of a user's class, by _smoothers.py or _solvers.py
  py::object run{};                          ///< of it on one mesh, from initialize on
  std::shared_ptr<TopologyArrays> arrays{};  ///< of the mesh of that run

  explicit PythonObjects(py::object of) : definition(std::move(of)) {}
  PythonObjects(const PythonObjects&) = delete;
  ~PythonObjects() {
    const py::gil_scoped_acquire gil;
    arrays.reset();
    run = {};
    definition = {};
  }
};

/// The parameters that a class declares, with their values.
class DeclaredParameters {
 public:
  /// declared: [(name, default, reason)].
  explicit DeclaredParameters(const py::object& declared) {
    for (const py::handle entry : declared) {
      const auto [name, value, reason] =
          py::cast<std::tuple<std::string, py::object, std::string>>(entry);
      Declared parameter{name, reason, 0.0};
      if (py::isinstance<py::str>(value))
        parameter.value = py::cast<std::string>(value);
      else if (py::isinstance<py::int_>(value))
        parameter.value = py::cast<int>(value);
      else
        parameter.value = py::cast<double>(value);
      all_.push_back(std::move(parameter));
    }
  }

  Parameters list() {
    Parameters parameters;
    for (auto& declared : all_)
      std::visit(
          [&](auto& value) {
            parameters.push_back({declared.name, declared.description, &value});
          },
          declared.value);
    return parameters;
  }

  /// Returns {name: value}; the GIL must be held.
  py::dict values() const {
    py::dict all;
    for (const auto& declared : all_)
      std::visit([&](const auto& value) { all[declared.name.c_str()] = value; }, declared.value);
    return all;
  }

 private:
  struct Declared {
    std::string name, description;
    std::variant<double, int, std::string> value;
  };
  std::vector<Declared> all_;
};

/// Gives a lent mesh back, whatever happens.
class GivenBack {
 public:
  explicit GivenBack(PythonMesh& lent) : lent_(&lent) {}
  ~GivenBack() { (void)now(); }
  GivenBack(const GivenBack&) = delete;
  /// Returns whether Python still has arrays of its points.
  bool now() {
    PythonMesh* const lent = std::exchange(lent_, nullptr);
    return lent != nullptr && lent->give_back();
  }

 private:
  PythonMesh* lent_;
};

}  // namespace smoothfem
