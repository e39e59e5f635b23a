// SPDX-License-Identifier: GPL-3.0-or-later
#include "python/module/python_smoother.h"

#include <pybind11/stl.h>
#include <unistd.h>

#include <filesystem>

#include "python/module/python_mesh.h"
#include "smoothing/base/interruption.h"
#include "smoothing/loop/python_methods.h"

namespace smoothfem {

namespace {

/// A parameter that a class declares.
struct DeclaredParameter {
  std::string name, description;
  std::variant<double, int, std::string> value;
};

/// Objects of Python that are let go of with the GIL held.
struct PythonObjects {
  py::object definition;                     ///< Definition of _smoothers.py
  py::object run{};                          ///< Run of _smoothers.py, from initialize on
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

/// A text of Python's, which may have parts that are not Unicode.
std::string utf8(const py::handle& text) {
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

/// Runs Python. _smoothers.py makes InputErrors of what smoothers do wrong; a program that has
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

py::module_ helpers() {
  return py::module_::import("smoothfem._smoothers");
}

/// A class of Python's as the loop takes it: quality and invalid cells are the loop's affair, and
/// nodes have the numbers that the user's mesh has.
template <int dim>
class PythonSmoother final : public Smoother<dim> {
 public:
  explicit PythonSmoother(py::object definition)
      : name_(py::cast<std::string>(definition.attr("name"))), python_(definition) {
    for (const py::handle entry : definition.attr("parameters")) {
      const auto [name, value, reason] =
          py::cast<std::tuple<std::string, py::object, std::string>>(entry);
      DeclaredParameter declared{name, reason, 0.0};
      if (py::isinstance<py::str>(value))
        declared.value = py::cast<std::string>(value);
      else if (py::isinstance<py::int_>(value))
        declared.value = py::cast<int>(value);
      else
        declared.value = py::cast<double>(value);
      declared_.push_back(std::move(declared));
    }
    stopping_.tolerance = py::cast<double>(definition.attr("tolerance"));
    stopping_.patience = py::cast<int>(definition.attr("patience"));
    stopping_.max_iterations = py::cast<int>(definition.attr("max_iterations"));
  }

  std::string_view name() const override { return name_; }
  SmootherTraits traits() const override { return {.needs_node_order = true}; }
  StoppingRule stopping() const override { return stopping_.rule(); }

  SmootherOrigin origin() override {
    return with_python([&] {
      SmootherOrigin origin;
      for (const auto& file : python_.definition.attr("files"))
        origin.files.emplace_back(py::cast<std::string>(file));
      return origin;
    });
  }

  Parameters parameters() override {
    Parameters all;
    for (auto& declared : declared_)
      std::visit(
          [&](auto& value) {
            all.push_back({declared.name, declared.description, &value});
          },
          declared.value);
    for (auto& parameter : stopping_.parameters()) all.push_back(std::move(parameter));
    return all;
  }

  void initialize(const SmoothingState<dim>& state) override {
    with_python([&] {
      py::dict values;
      for (const auto& declared : declared_)
        std::visit([&](const auto& value) { values[declared.name.c_str()] = value; },
                   declared.value);
      python_.arrays = std::make_shared<TopologyArrays>(state.mesh.shared_topology());
      // Lent without the right to write.
      auto& mesh = const_cast<Mesh<dim>&>(state.mesh);
      const auto lent = std::make_shared<PythonMesh>(&mesh, python_.arrays, false);
      const GivenBack given_back(*lent);
      python_.run = helpers().attr("Run")(python_.definition, values, lent);
    });
  }

  StepReport step(SmoothingState<dim>& state) override {
    with_python([&] {
      const auto lent = std::make_shared<PythonMesh>(&state.mesh, python_.arrays, true);
      GivenBack given_back(*lent);
      python_.run.attr("step")(lent);
      if (given_back.now())
        throw SmootherFailure(name_ +
                              ": step keeps mesh.points, or a part of it, for later; keep a copy, "
                              "mesh.points.copy(), and take mesh.points anew in each step");
    });
    return {};
  }

 private:
  /// Gives a lent mesh back, whatever happens.
  class GivenBack {
   public:
    explicit GivenBack(PythonMesh& lent) : lent_(&lent) {}
    ~GivenBack() { (void)now(); }
    GivenBack(const GivenBack&) = delete;
    bool now() {
      PythonMesh* const lent = std::exchange(lent_, nullptr);
      return lent != nullptr && lent->give_back();
    }

   private:
    PythonMesh* lent_;
  };

  std::string name_;
  std::vector<DeclaredParameter> declared_;
  QualityGainStopping stopping_;
  PythonObjects python_;
};

template <int dim>
Stages<dim> one_stage(const PythonObjects& objects) {
  return with_python([&] {
    Stages<dim> stages;
    stages.push_back(std::make_unique<PythonSmoother<dim>>(objects.definition));
    return stages;
  });
}

}  // namespace

MethodEntry method_of_definition(const py::object& definition) {
  const auto text = [&](const char* name) { return py::cast<std::string>(definition.attr(name)); };
  const auto shared = std::make_shared<const PythonObjects>(definition);
  return {.name = text("method_name"),
          .info = {.name = text("method_name"),
                   .title = text("title"),
                   .description = text("description"),
                   .source = text("source")},
          .factories = {.planar = [shared] { return one_stage<2>(*shared); },
                        .volume = [shared] { return one_stage<3>(*shared); }}};
}

MethodEntry make_python_method(const MethodInFile& method) {
  return with_python([&] {
    return method_of_definition(
        helpers().attr("definition_in")(method.file.string(), method.object, started_python()));
  });
}

}  // namespace smoothfem
