// SPDX-License-Identifier: GPL-3.0-or-later
#include "python/module/python_smoother.h"

#include <pybind11/stl.h>

#include "python/module/call_python.h"

namespace smoothfem {

namespace {

py::module_ helpers() {
  return py::module_::import("smoothfem._smoothers");
}

/// A class of Python's as the loop takes it: quality and invalid cells are the loop's affair, and
/// nodes have the numbers that the user's mesh has.
template <int dim>
class PythonSmoother final : public Smoother<dim> {
 public:
  explicit PythonSmoother(py::object definition)
      : name_(py::cast<std::string>(definition.attr("name"))),
        declared_(definition.attr("parameters")),
        python_(definition) {
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
    Parameters all = declared_.list();
    for (auto& parameter : stopping_.parameters()) all.push_back(std::move(parameter));
    return all;
  }

  void initialize(const SmoothingState<dim>& state) override {
    with_python([&] {
      python_.arrays = std::make_shared<TopologyArrays>(state.mesh.shared_topology());
      // Lent without the right to write.
      auto& mesh = const_cast<Mesh<dim>&>(state.mesh);
      const auto lent = std::make_shared<PythonMesh>(&mesh, python_.arrays, false);
      const GivenBack given_back(*lent);
      python_.run = helpers().attr("Run")(python_.definition, declared_.values(), lent);
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
  std::string name_;
  DeclaredParameters declared_;
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
