// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/adaptivity/solver_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/adaptivity/fixed_boundary.h"
#include "smoothing/base/scoped_timer.h"

namespace smoothfem {

namespace {

template <int dim>
class AnyProblemSolver final : public ProblemSolver<dim> {
 public:
  AnyProblemSolver(const Mesh<dim>& initial, MakeMeshSolver<dim> make)
      : mesh_(initial), make_(std::move(make)) {}

  void prepare(const Mesh<dim>& mesh, int degree) override {
    if (topology_ == mesh.shared_topology() && degree_ == degree) return;
    require_fixed_boundary(mesh.topology());
    if (!solver_ || degree_ != degree) solver_ = make_(degree);
    topology_ = mesh.shared_topology();
    degree_ = degree;
    solved_.clear();
  }

  bool has_energy() const override { return solver_->traits().has_energy; }

  double solve(std::span<const Point<dim>> coordinates) override {
    if (std::equal(coordinates.begin(), coordinates.end(), solved_.begin(), solved_.end()))
      return value_;
    const ScopedTimer timer(effort_.seconds);
    solved_.assign(coordinates.begin(), coordinates.end());
    mesh_.set_coordinates(solved_);
    indicators_.clear();
    const bool is_first = effort_.n_solves++ == 0;
    try {
      return value_ = energy();
    } catch (const InputError& error) {
      if (is_first) throw SmootherFailure(error.what());
      return value_ = std::numeric_limits<double>::infinity();
    }
  }

  std::vector<Point<dim>> energy_gradient() const override {
    require(has_energy(), "energy");
    auto gradient = solver_->energy_gradient();
    require_values(gradient.size() == mesh_.n_nodes() &&
                       std::all_of(gradient.begin(), gradient.end(),
                                   [](const Point<dim>& g) { return g.allFinite(); }),
                   "energy_gradient", "finite vector for each node");
    for (NodeIndex i = 0; i < gradient.size(); ++i)
      if (topology_->is_fixed(i)) gradient[i].setZero();
    return gradient;
  }

  std::vector<double> recovery_indicators() const override { return indicators(); }
  std::vector<double> residual_indicators() const override { return indicators(); }

  std::vector<CellTensor<dim>> recovery_tensors() const override {
    require(false, "error tensors");
    return {};
  }
  std::vector<CellTensor<dim>> recovered_hessians() const override {
    require(false, "second derivatives");
    return {};
  }

  SolveEffort effort() const override { return effort_; }

 private:
  double energy() {
    if (!has_energy()) {
      (void)indicators();
      return 0.0;
    }
    const double energy = solver_->energy(mesh_);
    require_values(std::isfinite(energy), "energy", "finite number");
    return energy;
  }

  const std::vector<double>& indicators() const {
    if (!indicators_.empty()) return indicators_;
    require(solver_->traits().has_indicators, "error indicators");
    indicators_ = solver_->indicators(mesh_);
    require_values(indicators_.size() == mesh_.n_cells() &&
                       std::all_of(indicators_.begin(), indicators_.end(),
                                   [](double eta) { return std::isfinite(eta) && eta >= 0.0; }),
                   "indicators", "finite number for each cell that is not negative");
    return indicators_;
  }

  static void require(bool has_it, const std::string& what) {
    if (!has_it) throw SmootherFailure("the solver gives no " + what + ", which this method needs");
  }

  static void require_values(bool are_valid, const std::string& function, const std::string& what) {
    if (!are_valid)
      throw SmootherFailure("the solver's function '" + function + "' does not give a " + what);
  }

  Mesh<dim> mesh_;
  const MakeMeshSolver<dim> make_;
  std::unique_ptr<MeshSolver<dim>> solver_;
  std::shared_ptr<const Topology> topology_;  ///< of the smoothed meshes, with their fixed nodes
  int degree_ = -1;
  std::vector<Point<dim>> solved_;  ///< nodes of the last solve
  double value_ = 0.0;
  mutable std::vector<double> indicators_;  ///< of the last solve; empty: not computed yet
  SolveEffort effort_;
};

template <int dim>
class AnyProblem final : public Problem<dim> {
 public:
  AnyProblem(const Mesh<dim>& initial, MakeMeshSolver<dim> make)
      : initial_(initial), make_(std::move(make)) {}

  std::unique_ptr<ProblemSolver<dim>> make_solver() const override {
    return std::make_unique<AnyProblemSolver<dim>>(initial_, make_);
  }

 private:
  const Mesh<dim> initial_;
  const MakeMeshSolver<dim> make_;
};

}  // namespace

template <int dim>
std::shared_ptr<const Problem<dim>> make_solver_problem(const Mesh<dim>& initial,
                                                        MakeMeshSolver<dim> make) {
  return std::make_shared<AnyProblem<dim>>(initial, std::move(make));
}
template std::shared_ptr<const Problem<2>> make_solver_problem(const Mesh<2>&, MakeMeshSolver<2>);
template std::shared_ptr<const Problem<3>> make_solver_problem(const Mesh<3>&, MakeMeshSolver<3>);

}  // namespace smoothfem
