// SPDX-License-Identifier: GPL-3.0-or-later
#include "python/module/python_solver.h"

#include <pybind11/stl.h>

#include <tuple>

#include "python/module/call_python.h"

namespace smoothfem {

namespace {

/// Objects of Python that are let go of with the GIL held.
struct SolverObjects {
  py::object definition;                     ///< SolverDefinition of _solvers.py
  py::object run{};                          ///< SolverRun of _solvers.py, from initialize on
  std::shared_ptr<TopologyArrays> arrays{};  ///< of the meshes of that run

  explicit SolverObjects(py::object of) : definition(std::move(of)) {}
  SolverObjects(const SolverObjects&) = delete;
  ~SolverObjects() {
    const py::gil_scoped_acquire gil;
    arrays.reset();
    run = {};
    definition = {};
  }
};

/// A class of Python's as a study takes it.
template <int dim>
class PythonSolver final : public MeshSolver<dim> {
 public:
  explicit PythonSolver(const py::object& definition)
      : declared_(definition.attr("parameters")), python_(definition) {
    for (const py::handle entry : definition.attr("numbers")) {
      auto [name, unit, meaning] =
          py::cast<std::tuple<std::string, std::string, std::string>>(entry);
      numbers_.push_back({std::move(name), std::move(unit), std::move(meaning)});
    }
  }

  Parameters parameters() override { return declared_.list(); }
  std::vector<NumberDescription> numbers() const override { return numbers_; }

  SmootherOrigin origin() override {
    return with_python([&] {
      SmootherOrigin origin;
      for (const auto& file : python_.definition.attr("files"))
        origin.files.emplace_back(py::cast<std::string>(file));
      return origin;
    });
  }

  void initialize(const Mesh<dim>& mesh, int degree) override {
    with_python([&] {
      python_.arrays = std::make_shared<TopologyArrays>(mesh.shared_topology());
      const auto lent = lend(mesh);
      const GivenBack given_back(*lent);
      python_.run = py::module_::import("smoothfem._solvers")
                        .attr("SolverRun")(python_.definition, declared_.values(), degree, lent);
    });
  }

  SolverResult solve(const Mesh<dim>& mesh) override {
    return with_python([&] {
      const auto lent = lend(mesh);
      const GivenBack given_back(*lent);
      SolverResult result;
      for (const py::handle entry : python_.run.attr("solve")(lent)) {
        auto [name, value] = py::cast<std::pair<std::string, double>>(entry);
        result.numbers.push_back({std::move(name), value});
      }
      return result;
    });
  }

 private:
  /// Lends a mesh without the right to write.
  std::shared_ptr<PythonMesh> lend(const Mesh<dim>& mesh) const {
    return std::make_shared<PythonMesh>(const_cast<Mesh<dim>*>(&mesh), python_.arrays, false);
  }

  DeclaredParameters declared_;
  std::vector<NumberDescription> numbers_;
  SolverObjects python_;
};

template <int dim>
std::unique_ptr<MeshSolver<dim>> solver_of(const SolverObjects& objects) {
  return with_python([&]() -> std::unique_ptr<MeshSolver<dim>> {
    return std::make_unique<PythonSolver<dim>>(objects.definition);
  });
}

}  // namespace

SolverMakers make_python_solver(const MethodInFile& solver) {
  return with_python([&] {
    const auto shared = std::make_shared<const SolverObjects>(
        py::module_::import("smoothfem._solvers")
            .attr("SolverDefinition")(solver.file.string(), solver.object, started_python()));
    return SolverMakers{.planar = [shared] { return solver_of<2>(*shared); },
                        .volume = [shared] { return solver_of<3>(*shared); }};
  });
}

}  // namespace smoothfem
