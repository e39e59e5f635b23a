// SPDX-License-Identifier: GPL-3.0-or-later
#include <mpi.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "fem/materials/materials_of_mesh.h"
#include "fem/poisson_solver.h"
#include "fem/ranks/mpi_session.h"
#include "fem/solutions/check_pieces.h"
#include "python/module/bind.h"
#include "python/module/python_mesh.h"
#include "smoothing/base/find_named.h"
#include "smoothing/quality/mesh_quality.h"

namespace smoothfem {

namespace {

/// Starts MPI, which Trilinos needs for volume meshes; it ends with the process.
void require_mpi() {
  int is_on = 0;
  MPI_Initialized(&is_on);
  if (is_on) return;
  begin_mpi();
  std::atexit([] {
    int is_over = 0;
    MPI_Finalized(&is_over);
    if (!is_over) MPI_Finalize();
  });
}

ConditionNumberMethod condition_number_method(const std::string& name) {
  const std::vector<std::string> names{"none", "lanczos", "verified"};
  find_named("way to compute condition numbers", name, names);
  return name == names[0]   ? ConditionNumberMethod::none
         : name == names[1] ? ConditionNumberMethod::lanczos
                            : ConditionNumberMethod::verified;
}

/// The problem that users give.
struct Given {
  py::object problem;  ///< a name, or (value, gradient, load) as expressions; None: u counts
  std::string u, diffusivity;
  std::vector<GroupDiffusivity> of_groups;
};

template <int dim>
ManufacturedSolution<dim> named_or_parsed_solution(const Given& given, const Mesh<dim>& mesh) {
  if (py::isinstance<py::str>(given.problem))
    return manufactured_solution<dim>(py::cast<std::string>(given.problem));
  const auto [value, gradient, load] =
      py::cast<std::tuple<std::string, std::string, std::string>>(given.problem);
  return parsed_solution<dim>(value, gradient, load, mesh.coordinates());
}

/// Derives gradient and load, as studies do.
template <int dim>
ManufacturedSolution<dim> solution_by_formula(const Given& given, const Mesh<dim>& mesh) {
  auto solution = derived_solution<dim>(given.u, given.diffusivity,
                                        sample_of<dim>(mesh.coordinates()), given.of_groups);
  if (!given.of_groups.empty()) return with_materials_of(std::move(solution), mesh);
  check_pieces(solution, mesh);
  return solution;
}

template <class Value>
py::array_t<Value> array_of(const std::vector<Value>& values) {
  return py::array_t<Value>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// The nodal solution and its errors.
template <int dim>
py::dict fields_of(const PoissonSolver<dim>& solver, const Mesh<dim>& mesh,
                   const ManufacturedSolution<dim>& solution) {
  const auto found = solver.discrete_solution(mesh, solution);
  std::vector<double> u(mesh.n_nodes()), l2, h1;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) u[i] = solution.value(mesh.coordinates()[i]);
  for (const ErrorOnCell& error : found.cell_errors) {
    l2.push_back(error.l2);
    h1.push_back(error.h1);
  }
  py::array_t<double> points({static_cast<py::ssize_t>(found.dof_points.size()), py::ssize_t{dim}});
  if (!found.dof_points.empty())
    std::copy_n(found.dof_points.data()->data(), points.size(), points.mutable_data());
  py::dict fields;
  fields["u_h"] = array_of(found.node_values);
  fields["u"] = array_of(u);
  fields["dof_points"] = points;
  fields["dof_values"] = array_of(found.dof_values);
  fields["cell_l2_errors"] = array_of(l2);
  fields["cell_h1_errors"] = array_of(h1);
  return fields;
}

py::dict record_of(const SolutionRecord& r) {
  using py::literals::operator""_a;
  return py::dict(
      "degree"_a = r.degree, "n_dofs"_a = r.n_dofs, "n_free"_a = r.n_free,
      "assembly_seconds"_a = r.assembly_seconds, "condition_number"_a = r.condition_number,
      "lambda_min"_a = r.lambda_min, "lambda_max"_a = r.lambda_max,
      "condition_method"_a = r.condition_method, "condition_residual"_a = r.condition_residual,
      "jacobi_condition_number"_a = r.jacobi_condition_number, "cg_iterations"_a = r.cg_iterations,
      "cg_seconds"_a = r.cg_seconds, "cg_converged"_a = r.cg_converged,
      "jacobi_cg_iterations"_a = r.jacobi_cg_iterations,
      "jacobi_cg_seconds"_a = r.jacobi_cg_seconds, "amg_cg_iterations"_a = r.amg_cg_iterations,
      "amg_setup_seconds"_a = r.amg_setup_seconds, "amg_cg_seconds"_a = r.amg_cg_seconds,
      "e_max"_a = r.e_max, "e_mean"_a = r.e_mean, "e_l2"_a = r.e_l2, "e_h1"_a = r.e_h1,
      "l2_error"_a = r.l2_error, "h1_error"_a = r.h1_error, "l2_best"_a = r.l2_best,
      "h1_best"_a = r.h1_best, "most_points"_a = r.most_points, "status"_a = r.status);
}

/// Returns the record, and the fields on the mesh.
py::tuple solve(const PythonMesh& mesh, const Given& given, const std::vector<std::string>& natural,
                int degree, const std::string& condition_number, bool multigrid,
                double cg_tolerance) {
  if (degree != 1 && degree != 2)
    throw InputError("finite elements of degree " + std::to_string(degree) +
                     " are not available; choose 1 or 2");
  // All other settings are those of studies, so that records can be compared.
  const PoissonOptions options{.degree = degree,
                               .natural_groups = natural,
                               .cg_tolerance = cg_tolerance,
                               .boundary_in_norm = true,
                               .condition_number = condition_number_method(condition_number),
                               .multigrid_cg = multigrid ? Recorded::always : Recorded::never,
                               .best_approximation = Recorded::always};
  return mesh.visit([&]<int dim, int spacedim>(const Mesh<dim, spacedim>& m) {
    if constexpr (dim != spacedim) {
      throw InputError("finite elements are not solved on surface meshes");
      return py::tuple();
    } else {
      if (dim == 3) require_mpi();
      ManufacturedSolution<dim> solution;
      if (!given.problem.is_none()) solution = named_or_parsed_solution<dim>(given, m);
      std::optional<PoissonSolver<dim>> solver;
      SolutionRecord record;
      {
        const py::gil_scoped_release others_may_run;
        require_valid(m);
        if (!given.u.empty()) solution = solution_by_formula<dim>(given, m);
        record = solver.emplace(&m, options).solve(m.coordinates(), solution);
      }
      return py::make_tuple(record_of(record), fields_of(*solver, m, solution));
    }
  });
}

/// name -> formula of the solution
py::dict problems(int dim) {
  if (dim != 2 && dim != 3) throw InputError("problems are available in dimension 2 and 3");
  py::dict all;
  with_dimension(dim, [&]<int d>() {
    for (const auto& solution : manufactured_solutions<d>())
      all[solution.name.c_str()] = solution.formula;
  });
  return all;
}

}  // namespace

void bind_solving(py::module_& module) {
  using Groups = std::vector<std::pair<std::string, std::string>>;
  module.def("solve", [](const PythonMesh& mesh, const py::object& problem, const std::string& u,
                         const std::string& diffusivity, const Groups& groups,
                         const std::vector<std::string>& natural, int degree,
                         const std::string& condition_number, bool multigrid, double tolerance) {
    Given given{problem, u, diffusivity, {}};
    for (const auto& [group, formula] : groups) given.of_groups.push_back({group, formula});
    return solve(mesh, given, natural, degree, condition_number, multigrid, tolerance);
  });
  module.def("problems", &problems);
}

}  // namespace smoothfem
