// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/poisson_problem.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <limits>

#include "fem/assembly.h"
#include "fem/conjugate_gradients.h"
#include "fem/energy.h"
#include "fem/gradient_recovery.h"
#include "fem/natural_load.h"
#include "fem/residual_indicator.h"
#include "fem/trilinos_matrix.h"
#include "smoothing/base/scoped_timer.h"
#include "smoothing/solution/combined_solver.h"

namespace smoothfem {

namespace {

/// Systems with the matrices of one pattern.
class LinearSolver {
 public:
  template <int dim>
  explicit LinearSolver(const FiniteElementSpace<dim>& space, const SparseMatrix& matrix) {
    constexpr std::size_t few = 3000;  // multigrid is slower than factors of so few rows in space
    if (dim == 2 || space.n_free < few) {
      cholesky_ = std::make_unique<Cholesky>();
      cholesky_->analyzePattern(matrix);
    } else {
      sliced_ = std::make_unique<SlicedMatrix>(matrix);
      multigrid_ = std::make_unique<TrilinosMatrix>(space);
    }
  }

  /// Returns whether there is a solution.
  bool solve(const SparseMatrix& matrix, const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    if (cholesky_) {
      cholesky_->factorize(matrix);
      if (cholesky_->info() != Eigen::Success) return false;
      x = cholesky_->solve(b);
      return true;
    }
    constexpr double tolerance = 1e-9;  // its square is what the energy sees
    sliced_->set_values(matrix);
    multigrid_->set_values(matrix);
    multigrid_->set_up_multigrid();
    const auto cg = conjugate_gradients(
        *sliced_, b, x,
        {.tolerance = tolerance,
         .max_iterations = static_cast<std::size_t>(matrix.rows()),
         .stop_if_indefinite = true},
        [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) { multigrid_->apply_multigrid(r, z); });
    return cg.end == ConjugateGradientsEnd::converged;
  }

 private:
  using Cholesky = Eigen::SimplicialLLT<Eigen::SparseMatrix<double>>;
  std::unique_ptr<Cholesky> cholesky_;
  std::unique_ptr<SlicedMatrix> sliced_;
  std::unique_ptr<TrilinosMatrix> multigrid_;
};

template <int dim>
class PoissonProblemSolver final : public ProblemSolver<dim> {
 public:
  PoissonProblemSolver(const ManufacturedSolution<dim>& solution,
                       const std::vector<std::string>& natural_groups)
      : solution_(solution), natural_groups_(natural_groups) {}

  void prepare(const Mesh<dim>& mesh, int degree) override {
    if (topology_ == mesh.shared_topology() && space_->degree == degree) return;
    check(mesh.topology());
    // One rule for all cells of a type: then J and its gradient are those of one function.
    constexpr TensorPoints points{.quadrilateral = 5, .hexahedron = 4};
    space_ = make_finite_element_space(&mesh, degree, points, {}, natural_groups_);
    topology_ = mesh.shared_topology();
    energy_ = std::make_unique<Energy<dim>>(space_, solution_);
    system_ = make_system(*space_);
    linear_ = std::make_unique<LinearSolver>(*space_, system_.matrix);
    number_cells();
    solved_.clear();
  }

  double solve(std::span<const Point<dim>> coordinates) override {
    if (std::equal(coordinates.begin(), coordinates.end(), solved_.begin(), solved_.end()))
      return value_;
    const ScopedTimer timer(effort_.seconds);
    ++effort_.n_solves;
    solved_.assign(coordinates.begin(), coordinates.end());
    x_ = space_->local_coordinates(coordinates);
    return value_ = solve_here() ? energy() : std::numeric_limits<double>::infinity();
  }

  std::vector<Point<dim>> energy_gradient() const override {
    const auto local = energy_->gradient(x_, u_);
    std::vector<Point<dim>> gradient(topology_->n_nodes(), Point<dim>::Zero());
    for (std::size_t i = 0; i < local.size(); ++i)
      if (!topology_->is_fixed(space_->nodes[i])) gradient[space_->nodes[i]] = local[i];
    return gradient;
  }

  std::vector<double> recovery_indicators() const override {
    return in_order_of_cells(recovery().differences());
  }

  std::vector<CellTensor<dim>> recovery_tensors() const override {
    return in_order_of_cells(recovery().difference_tensors());
  }

  std::vector<double> residual_indicators() const override {
    return in_order_of_cells(smoothfem::residual_indicators(*space_, x_, u_, solution_));
  }

  std::vector<CellTensor<dim>> recovered_hessians() const override {
    return in_order_of_cells(recovery().hessians());
  }

  SolveEffort effort() const override { return effort_; }

 private:
  GradientRecovery<dim> recovery() const { return {*space_, x_, u_, solution_}; }

  void check(const Topology& topology) const {
    for (NodeIndex i = 0; i < topology.n_nodes(); ++i)
      if (topology.on_boundary()[i] && !topology.is_fixed(i))
        throw InputError("node " + std::to_string(i) +
                         " of the boundary is not fixed, as methods that move nodes by the "
                         "solution need it; fix the boundary");
  }

  bool solve_here() {
    assemble(*space_, x_, solution_, Load::none, system_);
    if (system_.n_folded_cells > 0) return false;
    energy_->integrate_load(x_);
    energy_->add_load(system_.right_hand_side);
    Eigen::VectorXd free_values;
    if (!linear_->solve(system_.matrix, system_.right_hand_side, free_values)) return false;
    u_ = system_.exact;  // of which the boundary values stay
    u_.head(free_values.size()) = free_values;
    return true;
  }

  double energy() const {
    const auto n_free = static_cast<Eigen::Index>(space_->n_own);
    const auto boundary = u_.tail(u_.size() - n_free);
    double j = energy_->value(x_, u_, boundary.mean());
    if (space_->natural_facets.empty()) return j;
    Eigen::VectorXd natural = Eigen::VectorXd::Zero(n_free);
    add_natural_load(*space_, x_, solution_, natural);
    return j - 2.0 * natural.dot(u_.head(n_free));
  }

  /// Of the mesh, what the space has in its own.
  template <class T>
  std::vector<T> in_order_of_cells(const std::vector<T>& of_space) const {
    std::vector<T> of_cells(topology_->n_cells());
    for (std::size_t k = 0; k < of_space.size(); ++k) of_cells[cells_[k]] = of_space[k];
    return of_cells;
  }

  /// The mesh's cell of each of the space's, by its nodes.
  void number_cells() {
    cells_.clear();
    for (const auto& group : space_->groups)
      for (std::size_t first = 0; first < group.vertices.size();
           first += group.element.n_vertices) {
        std::vector<NodeIndex> nodes;
        for (std::size_t v = 0; v < group.element.n_vertices; ++v)
          nodes.push_back(space_->nodes[group.vertices[first + v]]);
        const auto around = topology_->node_cells(nodes[0]);
        cells_.push_back(*std::find_if(around.begin(), around.end(), [&](CellIndex c) {
          const auto of_cell = topology_->cell_nodes(c);
          return std::is_permutation(of_cell.begin(), of_cell.end(), nodes.begin(), nodes.end());
        }));
      }
  }

  const ManufacturedSolution<dim>& solution_;
  const std::vector<std::string>& natural_groups_;
  std::shared_ptr<const Topology> topology_;
  std::shared_ptr<const FiniteElementSpace<dim>> space_;
  std::unique_ptr<Energy<dim>> energy_;
  std::unique_ptr<LinearSolver> linear_;
  PoissonSystem system_;
  std::vector<CellIndex> cells_;
  std::vector<Point<dim>> solved_, x_;  ///< nodes of the last solve: the mesh's and the space's
  Eigen::VectorXd u_;                   ///< at the dofs
  double value_ = 0.0;
  SolveEffort effort_;
};

template <int dim>
class PoissonProblem final : public Problem<dim> {
 public:
  PoissonProblem(std::vector<ManufacturedSolution<dim>> solutions,
                 std::vector<std::string> natural_groups)
      : solutions_(std::move(solutions)), natural_groups_(std::move(natural_groups)) {}
  std::unique_ptr<ProblemSolver<dim>> make_solver() const override {
    std::vector<std::unique_ptr<ProblemSolver<dim>>> solvers;
    for (const auto& solution : solutions_)
      solvers.push_back(std::make_unique<PoissonProblemSolver<dim>>(solution, natural_groups_));
    return combined_solver(std::move(solvers));
  }

 private:
  std::vector<ManufacturedSolution<dim>> solutions_;
  std::vector<std::string> natural_groups_;
};

}  // namespace

template <int dim>
std::shared_ptr<const Problem<dim>> make_poisson_problem(ManufacturedSolution<dim> solution,
                                                         std::vector<std::string> natural_groups) {
  return make_poisson_problem(std::vector{std::move(solution)}, std::move(natural_groups));
}

template <int dim>
std::shared_ptr<const Problem<dim>> make_poisson_problem(
    std::vector<ManufacturedSolution<dim>> solutions, std::vector<std::string> natural_groups) {
  return std::make_shared<PoissonProblem<dim>>(std::move(solutions), std::move(natural_groups));
}

#define SMOOTHFEM_INSTANTIATE(dim)                                                             \
  template std::shared_ptr<const Problem<dim>> make_poisson_problem(ManufacturedSolution<dim>, \
                                                                    std::vector<std::string>); \
  template std::shared_ptr<const Problem<dim>> make_poisson_problem(                           \
      std::vector<ManufacturedSolution<dim>>, std::vector<std::string>);
SMOOTHFEM_INSTANTIATE(2)
SMOOTHFEM_INSTANTIATE(3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
