// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "fem/adaptivity/energy_solver.h"
#include "fem/poisson_solver.h"

namespace smoothfem {

/// Finite elements on several processes: the root says what is to be done, and the others do their
/// part of it. While the root does something else, such as smoothing, they sleep. For volume
/// meshes; with one process it is a solver like any other.
class SolverTeam {
 public:
  /// On the root.
  explicit SolverTeam(const Ranks& ranks) : ranks_(ranks) {}
  /// Releases the workers: `serve` returns on the other ranks.
  ~SolverTeam();
  SolverTeam(const SolverTeam&) = delete;

  /// On all ranks but the root: takes part until the root's team ends. options: the degree is the
  /// root's.
  static void serve(const Ranks& ranks, const PoissonOptions& options,
                    const std::vector<ManufacturedSolution<3>>& solutions);

  /// The functions of PoissonSolver, on the root. The solver before is given up first. solutions:
  /// those that the others have; number: of the one to solve.
  void make_solver(const Mesh<3>& mesh, const PoissonOptions& options);
  SolutionRecord solve(std::span<const Point<3>> coordinates,
                       const std::vector<ManufacturedSolution<3>>& solutions, std::size_t number,
                       bool is_result);
  std::vector<double> nodal_errors();
  std::vector<double> eigenvectors();
  void set_eigenvectors(const std::vector<double>& eigenvectors);

  /// See the function make_energy_solver. There may be several beside each other and beside that
  /// solver; all have to end before the team does. options: degree and natural groups. solutions,
  /// number: as above.
  std::unique_ptr<EnergySolver<3>> make_energy_solver(
      const Mesh<3>& mesh, const PoissonOptions& options,
      const std::vector<ManufacturedSolution<3>>& solutions, std::size_t number);

 private:
  const Ranks ranks_;
  std::unique_ptr<PoissonSolver<3>> solver_;
  std::size_t n_energy_solvers_ = 0;  ///< made so far: they are known by number
};

}  // namespace smoothfem
