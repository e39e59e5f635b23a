// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/adaptivity/poisson_problem.h"

#include <algorithm>

#include "fem/adaptivity/fixed_boundary.h"
#include "fem/adaptivity/gradient_recovery.h"
#include "fem/adaptivity/residual_indicator.h"
#include "smoothing/base/scoped_timer.h"
#include "smoothing/solution/combined_solver.h"

namespace smoothfem {

namespace {

template <int dim>
class PoissonProblemSolver final : public ProblemSolver<dim> {
 public:
  /// number: of the solution among those of the problem.
  PoissonProblemSolver(const ManufacturedSolution<dim>& solution,
                       const MakeEnergySolver<dim>& make_energy_solver, std::size_t number)
      : solution_(solution), make_energy_solver_(make_energy_solver), number_(number) {}

  void prepare(const Mesh<dim>& mesh, int degree) override {
    if (topology_ == mesh.shared_topology() && degree_ == degree) return;
    require_fixed_boundary(mesh.topology());
    topology_.reset();
    energy_.reset();  // frees memory before the next one is made
    energy_ = make_energy_solver_(mesh, degree, number_);
    topology_ = mesh.shared_topology();
    degree_ = degree;
    solved_.clear();
  }

  double solve(std::span<const Point<dim>> coordinates) override {
    if (std::equal(coordinates.begin(), coordinates.end(), solved_.begin(), solved_.end()))
      return value_;
    const ScopedTimer timer(effort_.seconds);
    ++effort_.n_solves;
    solved_.assign(coordinates.begin(), coordinates.end());
    return value_ = energy_->solve(coordinates);
  }

  std::vector<Point<dim>> energy_gradient() const override {
    auto gradient = energy_->gradient();
    for (NodeIndex i = 0; i < gradient.size(); ++i)
      if (topology_->is_fixed(i)) gradient[i].setZero();
    return gradient;
  }

  std::vector<double> recovery_indicators() const override {
    return of_cells([&](const auto& recovery) { return recovery.differences(); });
  }

  std::vector<CellTensor<dim>> recovery_tensors() const override {
    return of_cells([&](const auto& recovery) { return recovery.difference_tensors(); });
  }

  std::vector<CellTensor<dim>> recovered_hessians() const override {
    return of_cells([&](const auto& recovery) { return recovery.hessians(); });
  }

  std::vector<double> residual_indicators() const override {
    const auto [space, x, u] = energy_->function();
    return in_order_of_cells(space, smoothfem::residual_indicators(space, x, u, solution_));
  }

  SolveEffort effort() const override { return effort_; }

 private:
  /// Evaluates `measure` on the recovered gradient.
  template <class Measure>
  auto of_cells(const Measure& measure) const {
    const auto [space, x, u] = energy_->function();
    return in_order_of_cells(space, measure(GradientRecovery<dim>(space, x, u, solution_)));
  }

  /// Reorders values of the space's cells to the order of the mesh's cells.
  template <class T>
  std::vector<T> in_order_of_cells(const FiniteElementSpace<dim>& space,
                                   const std::vector<T>& of_space) const {
    std::vector<T> of_cells(topology_->n_cells());
    auto next = of_space.begin();
    for (const auto& group : space.groups)
      for (const CellIndex cell : group.numbers) of_cells[cell] = *next++;
    return of_cells;
  }

  const ManufacturedSolution<dim>& solution_;
  const MakeEnergySolver<dim>& make_energy_solver_;
  const std::size_t number_;
  std::shared_ptr<const Topology> topology_;
  int degree_ = 0;
  std::unique_ptr<EnergySolver<dim>> energy_;
  std::vector<Point<dim>> solved_;  ///< nodes of the last solve
  double value_ = 0.0;
  SolveEffort effort_;
};

template <int dim>
class PoissonProblem final : public Problem<dim> {
 public:
  PoissonProblem(std::vector<ManufacturedSolution<dim>> solutions,
                 const std::vector<std::string>& natural_groups)
      : solutions_(std::move(solutions)),
        make_energy_solver_(
            [this, natural_groups](const Mesh<dim>& mesh, int degree, std::size_t number) {
              return make_energy_solver(&mesh, degree, solutions_[number], natural_groups);
            }) {}
  PoissonProblem(std::vector<ManufacturedSolution<dim>> solutions, MakeEnergySolver<dim> make)
      : solutions_(std::move(solutions)), make_energy_solver_(std::move(make)) {}
  PoissonProblem(const PoissonProblem&) = delete;

  std::unique_ptr<ProblemSolver<dim>> make_solver() const override {
    std::vector<std::unique_ptr<ProblemSolver<dim>>> solvers;
    for (std::size_t number = 0; number < solutions_.size(); ++number)
      solvers.push_back(std::make_unique<PoissonProblemSolver<dim>>(solutions_[number],
                                                                    make_energy_solver_, number));
    return combined_solver(std::move(solvers));
  }

 private:
  const std::vector<ManufacturedSolution<dim>> solutions_;
  const MakeEnergySolver<dim> make_energy_solver_;
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
  return std::make_shared<PoissonProblem<dim>>(std::move(solutions), natural_groups);
}

template <int dim>
std::shared_ptr<const Problem<dim>> make_poisson_problem(
    std::vector<ManufacturedSolution<dim>> solutions, MakeEnergySolver<dim> make) {
  return std::make_shared<PoissonProblem<dim>>(std::move(solutions), std::move(make));
}

#define SMOOTHFEM_INSTANTIATE(dim)                                                             \
  template std::shared_ptr<const Problem<dim>> make_poisson_problem(ManufacturedSolution<dim>, \
                                                                    std::vector<std::string>); \
  template std::shared_ptr<const Problem<dim>> make_poisson_problem(                           \
      std::vector<ManufacturedSolution<dim>>, std::vector<std::string>);                       \
  template std::shared_ptr<const Problem<dim>> make_poisson_problem(                           \
      std::vector<ManufacturedSolution<dim>>, MakeEnergySolver<dim>);
SMOOTHFEM_INSTANTIATE(2)
SMOOTHFEM_INSTANTIATE(3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
