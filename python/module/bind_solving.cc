// SPDX-License-Identifier: GPL-3.0-or-later
#include <mpi.h>
#include <pybind11/stl.h>

#include <cstdlib>

#include "fem/poisson_solver.h"
#include "fem/ranks/mpi_session.h"
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

/// Converts a name, or (value, gradient, load) as expressions.
template <int dim>
ManufacturedSolution<dim> solution_of(const py::object& problem, const Mesh<dim>& mesh) {
  if (py::isinstance<py::str>(problem))
    return manufactured_solution<dim>(py::cast<std::string>(problem));
  const auto [value, gradient, load] =
      py::cast<std::tuple<std::string, std::string, std::string>>(problem);
  return parsed_solution<dim>(value, gradient, load, mesh.coordinates());
}

py::dict record_of(const SolutionRecord& r) {
  using py::literals::operator""_a;
  return py::dict(
      "degree"_a = r.degree, "n_dofs"_a = r.n_dofs, "n_free"_a = r.n_free,
      "assembly_seconds"_a = r.assembly_seconds, "condition_number"_a = r.condition_number,
      "lambda_min"_a = r.lambda_min, "lambda_max"_a = r.lambda_max,
      "condition_method"_a = r.condition_method, "condition_residual"_a = r.condition_residual,
      "cg_iterations"_a = r.cg_iterations, "cg_seconds"_a = r.cg_seconds,
      "cg_converged"_a = r.cg_converged, "jacobi_cg_iterations"_a = r.jacobi_cg_iterations,
      "jacobi_cg_seconds"_a = r.jacobi_cg_seconds, "amg_cg_iterations"_a = r.amg_cg_iterations,
      "amg_setup_seconds"_a = r.amg_setup_seconds, "amg_cg_seconds"_a = r.amg_cg_seconds,
      "e_max"_a = r.e_max, "e_mean"_a = r.e_mean, "e_l2"_a = r.e_l2, "e_h1"_a = r.e_h1,
      "l2_error"_a = r.l2_error, "h1_error"_a = r.h1_error, "most_points"_a = r.most_points,
      "status"_a = r.status);
}

py::dict solve(const PythonMesh& mesh, const py::object& problem, int degree,
               const std::string& condition_number, bool multigrid, double cg_tolerance) {
  if (degree != 1 && degree != 2)
    throw InputError("finite elements of degree " + std::to_string(degree) +
                     " are not available; choose 1 or 2");
  // All other settings are those of studies, so that records can be compared.
  const PoissonOptions options{.degree = degree,
                               .cg_tolerance = cg_tolerance,
                               .boundary_in_norm = true,
                               .condition_number = condition_number_method(condition_number),
                               .multigrid_cg = multigrid ? Recorded::always : Recorded::never};
  return record_of(mesh.visit([&]<int dim, int spacedim>(const Mesh<dim, spacedim>& m) {
    if constexpr (dim != spacedim) {
      throw InputError("finite elements are not solved on surface meshes");
      return SolutionRecord{};
    } else {
      const auto solution = solution_of<dim>(problem, m);
      if (dim == 3) require_mpi();
      const py::gil_scoped_release others_may_run;
      require_valid(m);
      return PoissonSolver<dim>(&m, options).solve(m.coordinates(), solution);
    }
  }));
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
  module.def("solve", &solve);
  module.def("problems", &problems);
}

}  // namespace smoothfem
