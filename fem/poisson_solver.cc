#include "fem/poisson_solver.h"

#include "fem/assembly.h"
#include "fem/condition_number.h"
#include "fem/conjugate_gradients.h"
#include "fem/error_norms.h"

namespace smoothfem {

struct PoissonSolver::Workspace {
  std::shared_ptr<const FiniteElementSpace> space;
  PoissonSystem system;
  SlicedMatrix sliced;  ///< the system's matrix, for products
  ConditionNumberSolver condition_solver;
  Eigen::VectorXd free_solution, discrete;

  explicit Workspace(std::shared_ptr<const FiniteElementSpace> shared)
      : space(std::move(shared)), system(make_system(*space)), sliced(system.matrix) {}
};

PoissonSolver::PoissonSolver(const PlanarMesh& mesh, const PoissonOptions& options)
    : options_(options),
      work_(std::make_unique<Workspace>(
          make_finite_element_space(mesh, options.degree, options.n_quadrilateral_points))) {}

PoissonSolver::PoissonSolver(const PoissonSolver& other)
    : options_(other.options_), work_(std::make_unique<Workspace>(other.work_->space)) {}

PoissonSolver::~PoissonSolver() = default;

namespace {

/// Sum of the squares of the boundary values: what they add to |b|^2 as identity rows.
double boundary_square_sum(const FiniteElementSpace& space, const Eigen::VectorXd& exact) {
  double sum = 0.0;
  for (std::size_t dof = 0; dof < space.n_dofs; ++dof)
    if (space.free_number[dof] == FiniteElementSpace::absent) {
      const double g = exact[static_cast<Eigen::Index>(dof)];
      sum += g * g;
    }
  return sum;
}

void record_condition_number(const ConditionNumber& condition, SolutionRecord& record) {
  record.lambda_min = condition.lambda_min;
  record.lambda_max = condition.lambda_max;
  record.condition_number = condition.value();
  record.condition_method = ConditionNumberSolver::method;
  if (!condition.verified) record.status = "condition number not verified";
}

}  // namespace

SolutionRecord PoissonSolver::solve(const PlanarMesh& mesh, const ManufacturedSolution& solution) {
  auto& [space, system, sliced, condition_solver, free_solution, discrete] = *work_;
  SolutionRecord record{.degree = options_.degree,
                        .n_dofs = space->n_dofs,
                        .n_free = space->n_free,
                        .condition_method = "none",
                        .status = "ok"};
  assemble(*space, mesh.coordinates(), solution,
           options_.galerkin_load ? Load::quadrature : Load::nodal, system);
  if (options_.condition_number)
    record_condition_number(condition_solver.compute(system.matrix), record);

  sliced.set_values(system.matrix);
  const double offset = options_.boundary_in_norm ? boundary_square_sum(*space, system.exact) : 0.0;
  const auto max_iterations = static_cast<std::size_t>(options_.max_cg_iterations_per_dof *
                                                       static_cast<double>(space->n_free));
  const auto run = [&](Preconditioner preconditioner) {
    return conjugate_gradients(sliced, system.right_hand_side, free_solution, options_.cg_tolerance,
                               max_iterations, preconditioner, offset);
  };
  if (options_.jacobi_cg) {
    const auto jacobi = run(Preconditioner::jacobi);
    record.jacobi_cg_iterations = jacobi.iterations;
    record.jacobi_cg_seconds = jacobi.seconds;
  }
  const auto cg = run(Preconditioner::none);  // last: its solution is the one whose errors count
  record.cg_iterations = cg.iterations;
  record.cg_seconds = cg.seconds;
  record.cg_converged = cg.converged;
  if (!cg.converged) record.status = "CG stopped at its limit of iterations";

  discrete = system.exact;
  for (std::size_t i = 0; i < space->n_free; ++i)
    discrete[space->free_dofs[i]] = free_solution[static_cast<Eigen::Index>(i)];
  const ErrorNorms norms =
      error_norms(*space, mesh.coordinates(), solution, system.exact, discrete);
  record.e_max = norms.e_max;
  record.e_mean = norms.e_mean;
  record.e_l2 = norms.e_l2;
  record.e_h1 = norms.e_h1;
  record.l2_error = norms.l2_error;
  record.h1_error = norms.h1_error;
  return record;
}

std::vector<double> PoissonSolver::nodal_errors() const {
  std::vector<double> errors(work_->space->vertex_dof.size(), 0.0);
  for (std::size_t node = 0; node < errors.size(); ++node) {
    const std::uint32_t dof = work_->space->vertex_dof[node];
    if (dof != FiniteElementSpace::absent)
      errors[node] = std::abs(work_->system.exact[dof] - work_->discrete[dof]);
  }
  return errors;
}

}  // namespace smoothfem
