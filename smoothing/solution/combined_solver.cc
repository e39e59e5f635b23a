// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/solution/combined_solver.h"

#include <Eigen/Eigenvalues>
#include <cassert>
#include <cmath>
#include <limits>

#include "smoothing/solution/error_indicators.h"

namespace smoothfem {

namespace {

/// Returns the positive semidefinite square root of a matrix that is positive semidefinite up to
/// rounding.
template <int dim>
CellTensor<dim> root(const CellTensor<dim>& square) {
  const Eigen::SelfAdjointEigenSolver<CellTensor<dim>> eigen(square);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         eigen.eigenvectors().transpose();
}

template <int dim>
class CombinedSolver final : public ProblemSolver<dim> {
 public:
  explicit CombinedSolver(std::vector<std::unique_ptr<ProblemSolver<dim>>> solvers)
      : solvers_(std::move(solvers)) {}

  void prepare(const Mesh<dim>& mesh, int degree) override {
    for (const auto& solver : solvers_) solver->prepare(mesh, degree);
    if (topology_ == mesh.shared_topology() && degree_ == degree) return;
    topology_ = mesh.shared_topology();
    degree_ = degree;
    weights_.clear();
  }

  double solve(std::span<const Point<dim>> coordinates) override {
    std::vector<double> energies;
    for (const auto& solver : solvers_) {
      energies.push_back(solver->solve(coordinates));
      if (!std::isfinite(energies.back())) return energies.back();
    }
    if (weights_.empty()) choose_weights(coordinates, energies);
    double sum = 0.0;
    for (std::size_t k = 0; k < energies.size(); ++k) sum += weights_[k] * energies[k];
    return sum;
  }

  std::vector<Point<dim>> energy_gradient() const override {
    return weighted_sum([](const auto& solver) { return solver.energy_gradient(); });
  }

  std::vector<double> recovery_indicators() const override {
    return root_of_squares([](const auto& solver) { return solver.recovery_indicators(); });
  }

  std::vector<CellTensor<dim>> recovery_tensors() const override {
    return weighted_sum([](const auto& solver) { return solver.recovery_tensors(); });
  }

  std::vector<double> residual_indicators() const override {
    return root_of_squares([](const auto& solver) { return solver.residual_indicators(); });
  }

  std::vector<CellTensor<dim>> recovered_hessians() const override {
    auto sums = weighted_sum([](const auto& solver) {
      auto squares = solver.recovered_hessians();
      for (auto& h : squares) h = (h * h).eval();
      return squares;
    });
    for (auto& sum : sums) sum = root<dim>(sum);
    return sums;
  }

  SolveEffort effort() const override {
    SolveEffort sum;
    for (const auto& solver : solvers_) {
      const SolveEffort effort = solver->effort();
      sum.n_solves += effort.n_solves;
      sum.seconds += effort.seconds;
    }
    return sum;
  }

 private:
  void choose_weights(std::span<const Point<dim>> coordinates,
                      const std::vector<double>& energies) {
    constexpr double rounding = 1e-20;  // of a squared error, relative to the energy
    const Mesh<dim> mesh(topology_, {coordinates.begin(), coordinates.end()});
    std::vector<double> squares;  // infinite for problems without error
    double sum = 0.0, n = 0.0;
    for (std::size_t k = 0; k < solvers_.size(); ++k) {
      const double square = estimated_squared_error(mesh, *solvers_[k]);
      const bool has_error = square > rounding * std::abs(energies[k]);
      squares.push_back(has_error ? square : std::numeric_limits<double>::infinity());
      if (has_error) sum += square;
      if (has_error) n += 1.0;
    }
    // Their scale is free: with this one the weights of equal problems are 1.
    for (const double square : squares) weights_.push_back(n > 0.0 ? sum / n / square : 1.0);
  }

  /// values: of one solver, one for each node or cell.
  template <class Values>
  auto weighted_sum(const Values& values) const {
    auto sums = values(*solvers_.front());
    for (auto& sum : sums) sum *= weights_.front();
    for (std::size_t k = 1; k < solvers_.size(); ++k) {
      const auto of_one = values(*solvers_[k]);
      for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += weights_[k] * of_one[i];
    }
    return sums;
  }

  template <class Indicators>
  std::vector<double> root_of_squares(const Indicators& indicators) const {
    auto sums = weighted_sum([&](const auto& solver) {
      auto squares = indicators(solver);
      for (double& e : squares) e *= e;
      return squares;
    });
    for (double& sum : sums) sum = std::sqrt(sum);
    return sums;
  }

  std::vector<std::unique_ptr<ProblemSolver<dim>>> solvers_;
  std::shared_ptr<const Topology> topology_;
  int degree_ = 0;
  std::vector<double> weights_;  ///< empty: chosen at the next solve
};

}  // namespace

template <int dim>
std::unique_ptr<ProblemSolver<dim>> combined_solver(
    std::vector<std::unique_ptr<ProblemSolver<dim>>> solvers) {
  assert(!solvers.empty());
  if (solvers.size() == 1) return std::move(solvers.front());
  return std::make_unique<CombinedSolver<dim>>(std::move(solvers));
}

template std::unique_ptr<ProblemSolver<2>> combined_solver(
    std::vector<std::unique_ptr<ProblemSolver<2>>>);
template std::unique_ptr<ProblemSolver<3>> combined_solver(
    std::vector<std::unique_ptr<ProblemSolver<3>>>);

}  // namespace smoothfem
