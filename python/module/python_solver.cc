// SPDX-License-Identifier: GPL-3.0-or-later
#include "python/module/python_solver.h"

#include <pybind11/stl.h>

#include <tuple>

#include "fem/solvers/matrix_numbers.h"
#include "python/module/call_python.h"

namespace smoothfem {

namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Indices = py::array_t<int, py::array::c_style | py::array::forcecast>;

/// given: (offsets, columns, values, right-hand side) of a matrix in compressed rows.
std::vector<SolverNumber> numbers_of_matrix(const py::tuple& given) {
  const auto offsets = py::cast<Indices>(given[0]), columns = py::cast<Indices>(given[1]);
  const auto values = py::cast<Numbers>(given[2]), b = py::cast<Numbers>(given[3]);
  const Eigen::Index n = offsets.size() - 1;
  const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor, int>> a(
      n, n, values.size(), offsets.data(), columns.data(), values.data());
  return matrix_numbers(a, Eigen::Map<const Eigen::VectorXd>(b.data(), b.size()));
}

/// A class of Python's as a study takes it.
template <int dim>
class PythonSolver final : public MeshSolver<dim> {
 public:
  explicit PythonSolver(const py::object& definition)
      : declared_(definition.attr("parameters")), python_(definition) {
    traits_.needs_mpi = py::cast<bool>(definition.attr("gives_matrix"));
    traits_.takes_ties = true;  // the class gets the mesh as it is
    traits_.takes_curved_cells = py::cast<bool>(definition.attr("takes_curved_cells"));
    traits_.degrees = py::cast<std::vector<int>>(definition.attr("degrees"));
    traits_.has_energy = py::cast<bool>(definition.attr("has_energy"));
    traits_.has_indicators = py::cast<bool>(definition.attr("has_indicators"));
    for (const py::handle entry : definition.attr("numbers")) {
      auto [name, unit, meaning] =
          py::cast<std::tuple<std::string, std::string, std::string>>(entry);
      numbers_.push_back({std::move(name), std::move(unit), std::move(meaning)});
    }
    if (!traits_.needs_mpi) return;
    for (auto& number : descriptions_of_matrix_numbers()) numbers_.push_back(std::move(number));
  }

  SolverTraits traits() const override { return traits_; }

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
      const py::tuple found = python_.run.attr("solve")(lent);
      for (const py::handle entry : found[0]) {
        auto [name, value] = py::cast<std::pair<std::string, double>>(entry);
        result.numbers.push_back({std::move(name), value});
      }
      if (!found[1].is_none())
        for (auto& number : numbers_of_matrix(found[1]))
          result.numbers.push_back(std::move(number));
      return result;
    });
  }

  double energy(const Mesh<dim>& mesh) override {
    return with_python([&] {
      const auto lent = lend(mesh);
      const GivenBack given_back(*lent);
      return py::cast<double>(python_.run.attr("energy")(lent));
    });
  }

  std::vector<Point<dim>> energy_gradient() override {
    return with_python([&] {
      const auto values = py::cast<Numbers>(python_.run.attr("energy_gradient")());
      std::vector<Point<dim>> gradient(static_cast<std::size_t>(values.shape(0)));
      std::copy_n(values.data(), values.size(), gradient.front().data());
      return gradient;
    });
  }

  std::vector<double> indicators(const Mesh<dim>& mesh) override {
    return with_python([&] {
      const auto lent = lend(mesh);
      const GivenBack given_back(*lent);
      const auto values = py::cast<Numbers>(python_.run.attr("indicators")(lent));
      return std::vector<double>(values.data(), values.data() + values.size());
    });
  }

 private:
  /// Lends a mesh without the right to write.
  std::shared_ptr<PythonMesh> lend(const Mesh<dim>& mesh) const {
    return std::make_shared<PythonMesh>(const_cast<Mesh<dim>*>(&mesh), python_.arrays, false);
  }

  SolverTraits traits_;
  DeclaredParameters declared_;
  std::vector<NumberDescription> numbers_;
  PythonObjects python_;
};

template <int dim>
std::unique_ptr<MeshSolver<dim>> solver_of(const PythonObjects& objects) {
  return with_python([&]() -> std::unique_ptr<MeshSolver<dim>> {
    return std::make_unique<PythonSolver<dim>>(objects.definition);
  });
}

}  // namespace

SolverMakers make_python_solver(const MethodInFile& solver) {
  return with_python([&] {
    const auto shared = std::make_shared<const PythonObjects>(
        py::module_::import("smoothfem._solvers")
            .attr("SolverDefinition")(solver.file.string(), solver.object, started_python()));
    return SolverMakers{.planar = [shared] { return solver_of<2>(*shared); },
                        .volume = [shared] { return solver_of<3>(*shared); }};
  });
}

}  // namespace smoothfem
