// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/poisson_solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "fem/assembly/best_approximation.h"
#include "fem/assembly/error_norms.h"
#include "fem/linear_algebra/condition_number.h"
#include "fem/linear_algebra/conjugate_gradients.h"

namespace smoothfem {

namespace {

constexpr double short_seconds = 0.1;

double seconds_since(std::chrono::steady_clock::time_point started) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
}

/// Sets the values at tied dofs from those at the others.
template <int dim>
void set_tied_values(const FiniteElementSpace<dim>& space, Eigen::VectorXd& values) {
  for (auto dof = static_cast<std::uint32_t>(space.n_local - space.ties.size());
       dof < space.n_local; ++dof) {
    double mean = 0.0;
    space.for_each_master(
        dof, [&](std::uint32_t master, double weight) { mean += weight * values[master]; });
    values[dof] = mean;
  }
}

/// Returns the sum of the squares of the boundary values, which they add to |b|^2 as identity rows.
template <int dim>
double boundary_square_sum(const FiniteElementSpace<dim>& space, const Eigen::VectorXd& exact) {
  return space.ranks.sum(exact
                             .segment(static_cast<Eigen::Index>(space.n_columns),
                                      static_cast<Eigen::Index>(space.n_own_boundary))
                             .squaredNorm());
}

}  // namespace

template <int dim>
struct PoissonSolver<dim>::Workspace {
  std::shared_ptr<const FiniteElementSpace<dim>> space;
  std::size_t n_mesh_nodes;  ///< on the root, or of each rank's part
  PoissonSystem system;
  SlicedMatrix sliced;                       ///< the system's matrix, for products
  std::unique_ptr<TrilinosMatrix> trilinos;  ///< made at first use
  CholeskyConditionNumber cholesky;
  IterativeConditionNumber iterative;
  Eigen::VectorXd free_solution, discrete;
  std::vector<double> exact_at_midside;  ///< of a curved space: u at local nodes without a dof
  bool is_warm = false;                  ///< it has solved before

  Workspace(std::shared_ptr<const FiniteElementSpace<dim>> shared, std::size_t n_nodes)
      : space(std::move(shared)),
        n_mesh_nodes(n_nodes),
        system(make_system(*space)),
        sliced(system.matrix, space->ranks, space->halo) {}

  /// Returns the options of CG for the assembled system. Collective.
  ConjugateGradientsOptions options_of_cg(const PoissonOptions& options) const {
    return {
        .tolerance = options.cg_tolerance,
        .norm_offset = options.boundary_in_norm ? boundary_square_sum(*space, system.exact) : 0.0,
        .max_iterations = static_cast<std::size_t>(options.max_cg_iterations_per_dof *
                                                   static_cast<double>(space->n_free)),
        .max_seconds = options.max_cg_seconds};
  }

  /// Sets multigrid up for the present matrix; returns the time it took.
  double set_up_multigrid() {
    if (!trilinos) trilinos = std::make_unique<TrilinosMatrix>(*space);
    trilinos->set_values(system.matrix);
    const auto started = std::chrono::steady_clock::now();
    trilinos->set_up_multigrid();
    return seconds_since(started);
  }

  bool is_tiny() const { return space->n_free <= dense_limit; }
  bool needs_multigrid() const { return !is_tiny() && (dim == 3 || space->ranks.size() > 1); }

  /// Call set_up_multigrid before, if it is needed.
  ConditionNumber verified_condition_number() {
    if (is_tiny())
      return dense_condition_number(system.matrix, space->column_numbers, space->n_free,
                                    space->ranks);
    return needs_multigrid() ? iterative.compute(*trilinos) : cholesky.compute(system.matrix);
  }

  /// Returns the errors of the best approximation to u; nothing if CG does not find it. Replaces
  /// the system by that of the approximation. Collective.
  std::optional<ErrorNorms> best_errors(const std::vector<Point<dim>>& x,
                                        const ManufacturedSolution<dim>& solution, Norm norm,
                                        ConjugateGradientsOptions options) {
    options.tolerance = 1e-10;  // the error of the norm is about its square
    options.norm_offset = 0.0;
    options.stop_if_indefinite = true;
    assemble_projection(*space, x, solution, norm, system);
    sliced.set_values(system.matrix);
    Eigen::VectorXd best;
    const auto run = conjugate_gradients(sliced, system.right_hand_side, best, options,
                                         jacobi_preconditioner(sliced));
    if (run.end != ConjugateGradientsEnd::converged) return {};
    Eigen::VectorXd values = system.exact;
    values.head(best.size()) = best;
    set_tied_values(*space, values);
    return error_norms(*space, x, solution, system.exact, values);
  }
};

template <int dim>
PoissonSolver<dim>::PoissonSolver(const Mesh<dim>* mesh, const PoissonOptions& options,
                                  const Ranks& ranks)
    : options_(options),
      work_(std::make_unique<Workspace>(
          make_finite_element_space(mesh, options.degree, options.tensor_points, ranks,
                                    options.natural_groups, options.ties.get(), options.geometry),
          mesh == nullptr ? 0 : mesh->n_nodes())) {}

template <int dim>
PoissonSolver<dim>::PoissonSolver(const PoissonSolver& other)
    : options_(other.options_),
      work_(std::make_unique<Workspace>(other.work_->space, other.work_->n_mesh_nodes)) {}

template <int dim>
PoissonSolver<dim>::~PoissonSolver() = default;

namespace {

void add_remark(const std::string& remark, SolutionRecord& record) {
  record.status = record.status == "ok" ? remark : record.status + "; " + remark;
}

void record_condition_number(const ConditionNumber& condition, SolutionRecord& record) {
  record.lambda_min = condition.lambda_min;
  record.lambda_max = condition.lambda_max;
  if (condition.lambda_min > 0.0) record.condition_number = condition.value();
  record.condition_method = condition.method;
  record.condition_residual = condition.residual();
}

void record_errors(const ErrorNorms& norms, SolutionRecord& record) {
  record.e_max = norms.e_max;
  record.e_mean = norms.e_mean;
  record.e_l2 = norms.e_l2;
  record.e_h1 = norms.e_h1;
  record.l2_error = norms.l2_error;
  record.h1_error = norms.h1_error;
}

/// Records the points of hexahedra with chosen rules. Collective.
void record_points(const adaptive_quadrature::Use& of_matrix,
                   const adaptive_quadrature::Use& of_errors, const Ranks& ranks,
                   SolutionRecord& record) {
  record.most_points = static_cast<int>(
      ranks.max(static_cast<double>(std::max(of_matrix.max_points, of_errors.max_points))));
  const std::size_t n = ranks.sum(std::max(of_matrix.n_unsettled, of_errors.n_unsettled));
  if (n > 0)
    add_remark(std::to_string(n) + (n == 1 ? " cell is" : " cells are") +
                   " integrated with an error that may be above 1e-4",
               record);
}

void record_conjugate_gradients(const ConjugateGradientsResult& cg, SolutionRecord& record) {
  record.cg_iterations = cg.iterations;
  record.cg_seconds = cg.seconds;
  record.cg_converged = cg.end == ConjugateGradientsEnd::converged;
  if (cg.end == ConjugateGradientsEnd::iteration_limit)
    add_remark("CG stopped at its limit of iterations", record);
  if (cg.end == ConjugateGradientsEnd::time_limit)
    add_remark("CG stopped at its limit of time", record);
}

/// Records the cost of a run whose solution is not used. A run that has not converged has no cost.
void record_cost(const std::string& name, const ConjugateGradientsResult& run,
                 std::size_t& iterations, double& seconds, SolutionRecord& record) {
  if (run.end == ConjugateGradientsEnd::converged) {
    iterations = run.iterations;
    seconds = run.seconds;
  } else {
    add_remark("CG with " + name + " did not converge", record);
  }
}

}  // namespace

template <int dim>
SolutionRecord PoissonSolver<dim>::solve(std::span<const Point<dim>> coordinates,
                                         const ManufacturedSolution<dim>& solution,
                                         bool is_result) {
  auto& work = *work_;
  const auto& space = *work.space;
  SolutionRecord record{.degree = options_.degree,
                        .n_dofs = space.n_dofs,
                        .n_free = space.n_free,
                        .condition_method = "none",
                        .status = "ok"};
  const auto asked_for = [&](Recorded what) {
    return what == Recorded::always || (what == Recorded::results && is_result);
  };
  const bool with_multigrid_cg = asked_for(options_.multigrid_cg);
  const bool verified = options_.condition_number == ConditionNumberMethod::verified ||
                        (options_.condition_number == ConditionNumberMethod::lanczos && is_result);
  const auto x = space.local_coordinates(coordinates);
  const auto solve_system = [&] {
    const auto started = std::chrono::steady_clock::now();
    assemble(space, x, solution, options_.load, work.system);
    work.sliced.set_values(work.system.matrix);
    record.assembly_seconds = seconds_since(started);
    if (const std::size_t n = space.ranks.sum(work.system.n_folded_cells); n > 0)
      add_remark(std::to_string(n) + (n == 1 ? " cell is" : " cells are") + " folded inside",
                 record);

    ConjugateGradientsOptions cg_options = work.options_of_cg(options_);
    const auto run = [&](const Preconditioner& preconditioner) {
      return conjugate_gradients(work.sliced, work.system.right_hand_side, work.free_solution,
                                 cg_options, preconditioner);
    };
    // Preconditioned runs measure the cost of a solution, if there is one.
    cg_options.stop_if_indefinite = true;
    if (asked_for(options_.jacobi_cg)) {
      const auto jacobi = run(jacobi_preconditioner(work.sliced));
      record_cost("Jacobi", jacobi, record.jacobi_cg_iterations, record.jacobi_cg_seconds, record);
      if (const auto scaled = lanczos_condition_number(jacobi.lanczos); scaled.lambda_min > 0.0)
        record.jacobi_condition_number = scaled.value();
    }
    if (with_multigrid_cg || (verified && work.needs_multigrid()))
      record.amg_setup_seconds = work.set_up_multigrid();
    if (with_multigrid_cg) {
      const auto multigrid = run([&](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
        work.trilinos->apply_multigrid(r, z);
      });
      record_cost("multigrid", multigrid, record.amg_cg_iterations, record.amg_cg_seconds, record);
    }
    cg_options.stop_if_indefinite = false;  // as in the thesis: its iterate counts
    const auto cg = run({});                // last: its solution is the one whose errors count
    record_conjugate_gradients(cg, record);
    return cg;
  };
  const SolutionRecord blank = record;
  const auto started = std::chrono::steady_clock::now();
  auto cg = solve_system();
  // A first solution also loads code and touches new memory, so that its times are too long. Where
  // that counts, the times of a second one are recorded.
  if (!work.is_warm && space.ranks.max(seconds_since(started)) < short_seconds) {
    record = blank;
    cg = solve_system();
  }
  work.is_warm = true;

  if (options_.condition_number != ConditionNumberMethod::none) {
    const auto lanczos = lanczos_condition_number(cg.lanczos);
    record_condition_number(
        verified ? better_of(work.verified_condition_number(), lanczos) : lanczos, record);
    if (verified && !(record.condition_residual <= verified_residual))
      add_remark("condition number not verified", record);
  }

  work.discrete = work.system.exact;
  work.discrete.head(work.free_solution.size()) = work.free_solution;
  set_tied_values(space, work.discrete);
  const ErrorNorms norms = error_norms(space, x, solution, work.system.exact, work.discrete);
  record_errors(norms, record);
  if (!std::isfinite(norms.l2_error) || !std::isfinite(norms.h1_error) ||
      !std::isfinite(norms.e_max)) {
    record.cg_converged = false;
    add_remark("numbers have overflowed", record);
  }
  if (space.is_curved) {
    work.exact_at_midside.assign(space.nodes.size(), 0.0);
    for (std::size_t node = 0; node < space.nodes.size(); ++node)
      if (space.vertex_dof[node] == space.absent)
        work.exact_at_midside[node] = solution.value(x[node]);
  }
  record_points(work.system.points, norms.points, space.ranks, record);
  if (asked_for(options_.best_approximation)) {
    const auto cg_options = work.options_of_cg(options_);
    const auto in_l2 = work.best_errors(x, solution, Norm::l2, cg_options),
               in_h1 = work.best_errors(x, solution, Norm::h1, cg_options);
    if (in_l2) record.l2_best = in_l2->l2_error;
    if (in_h1) record.h1_best = in_h1->h1_error;
    if (!in_l2 || !in_h1) add_remark("CG did not find the best approximation", record);
  }
  return record;
}

namespace {

/// Returns u_h at the local nodes; NaN at nodes that no cell uses. u_h: at the dofs. Where curved
/// cells have a node but no dof, u_h follows from earlier points of the mapping as a substitute
/// point does: on the reference cell these sums are exact for the functions of the element.
template <int dim>
std::vector<double> values_at_nodes(const FiniteElementSpace<dim>& space,
                                    const Eigen::VectorXd& u_h) {
  std::vector<double> values(space.nodes.size() + space.substitute_points.size(),
                             std::numeric_limits<double>::quiet_NaN());
  for (std::size_t node = 0; node < space.nodes.size(); ++node)
    if (const std::uint32_t dof = space.vertex_dof[node]; dof != space.absent)
      values[node] = u_h[dof];
  for (std::size_t dof = 0; dof < space.curved_dof_points.size(); ++dof)
    values[space.curved_dof_points[dof]] = u_h[static_cast<Eigen::Index>(dof)];
  for (const ElementCells& group : space.groups)
    for (std::size_t cell = 0; cell < group.n_cells(); ++cell)
      for (std::size_t k = group.element.n_vertices; k < group.element.mapping.size(); ++k) {
        const NodeIndex* points = group.mapping_points(cell);
        if (!std::isnan(values[points[k]])) continue;
        values[points[k]] = 0.0;
        for (const auto& [earlier, weight] : group.element.mapping.substitutes[k])
          values[points[k]] += weight * values[points[earlier]];
      }
  values.resize(space.nodes.size());
  return values;
}

}  // namespace

template <int dim>
std::vector<double> PoissonSolver<dim>::nodal_errors() const {
  const auto& space = *work_->space;
  auto local = values_at_nodes(space, work_->discrete);
  for (std::size_t node = 0; node < local.size(); ++node) {
    const std::uint32_t dof = space.vertex_dof[node];
    if (dof != space.absent)
      local[node] = std::abs(work_->system.exact[dof] - work_->discrete[dof]);
    else
      local[node] =
          std::isnan(local[node]) ? 0.0 : std::abs(work_->exact_at_midside[node] - local[node]);
  }
  if (space.in_parts) return local;
  // Nodes of several ranks occur several times, with the same value.
  const auto of_ranks = space.ranks.gather(local);
  std::vector<double> errors(work_->n_mesh_nodes, 0.0);
  for (std::size_t k = 0; k < of_ranks.size(); ++k) errors[space.nodes_of_ranks[k]] = of_ranks[k];
  return errors;
}

namespace {

/// Returns the mesh's cell of each of this rank's cells, in the order of cell_errors.
template <int dim>
std::vector<CellIndex> mesh_cells(const FiniteElementSpace<dim>& space) {
  std::vector<CellIndex> cells;
  for (const ElementCells& group : space.groups)
    cells.insert(cells.end(), group.numbers.begin(),
                 group.numbers.begin() + static_cast<std::ptrdiff_t>(group.n_own));
  return cells;
}

}  // namespace

template <int dim>
DiscreteSolution<dim> PoissonSolver<dim>::discrete_solution(
    const Mesh<dim>& mesh, const ManufacturedSolution<dim>& solution) const {
  const auto& space = *work_->space;
  const Eigen::VectorXd& u_h = work_->discrete;
  const auto x = space.local_coordinates(mesh.coordinates());
  DiscreteSolution<dim> result{.dof_points = space.dof_points(x),
                               .dof_values = {u_h.begin(), u_h.end()},
                               .node_values = {},
                               .cell_errors = {}};
  result.node_values = values_at_nodes(space, u_h);  // one process has the mesh's numbers
  const auto cells = mesh_cells(space);
  const auto errors = cell_errors(space, x, solution, work_->system.exact, u_h);
  result.cell_errors.resize(mesh.n_cells());
  for (std::size_t k = 0; k < cells.size(); ++k) result.cell_errors[cells[k]] = errors[k];
  return result;
}

template <int dim>
std::vector<double> PoissonSolver<dim>::eigenvectors() const {
  return work_->space->ranks.gather(work_->iterative.eigenvectors());
}

template <int dim>
void PoissonSolver<dim>::set_eigenvectors(const std::vector<double>& eigenvectors) {
  const auto& space = *work_->space;
  bool fits = eigenvectors.size() == 2 * space.n_free;
  space.ranks.broadcast(fits);
  work_->iterative.set_eigenvectors(fits ? space.ranks.scatter(eigenvectors, 2 * space.n_own)
                                         : std::vector<double>());
}

template class PoissonSolver<2>;
template class PoissonSolver<3>;

}  // namespace smoothfem
