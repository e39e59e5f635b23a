// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "fem/adaptivity/energy_solver.h"
#include "fem/poisson_solver.h"
#include "studies/framework/definition/study.h"

namespace smoothfem {

/// Finite elements on several processes, for volume meshes. The root sends commands, and the other
/// ranks do their part. They sleep while the root does something else, such as smoothing. With one
/// process it is an ordinary solver.
class SolverTeam {
 public:
  /// Makes the root's team.
  explicit SolverTeam(const Ranks& ranks) : ranks_(ranks) {}
  /// Ends the team: `serve` returns on the other ranks.
  ~SolverTeam();
  SolverTeam(const SolverTeam&) = delete;

  /// Takes part on a rank other than the root until the root's team ends. options: except the
  /// degree, which the root sends. solvers: the study's, in its order.
  static void serve(const Ranks& ranks, const PoissonOptions& options,
                    const std::vector<ManufacturedSolution<3>>& solutions,
                    const std::vector<StudySolver>& solvers);

  /// These are the functions of PoissonSolver, on the root. A new solver replaces the one before.
  /// solutions: the solutions of the other ranks. number: index of the solution to solve.
  void make_solver(const Mesh<3>& mesh, const PoissonOptions& options);
  SolutionRecord solve(std::span<const Point<3>> coordinates,
                       const std::vector<ManufacturedSolution<3>>& solutions, std::size_t number,
                       bool is_result);
  std::vector<double> nodal_errors();
  std::vector<double> eigenvectors();
  void set_eigenvectors(const std::vector<double>& eigenvectors);

  /// Makes a solver (see the function make_energy_solver). There may be several at a time, in
  /// addition to the solver above. All must end before the team does. options: degree and natural
  /// groups. solutions, number: as above.
  std::unique_ptr<EnergySolver<3>> make_energy_solver(
      const Mesh<3>& mesh, const PoissonOptions& options,
      const std::vector<ManufacturedSolution<3>>& solutions, std::size_t number);

  int n_ranks() const { return ranks_.size(); }

  /// Makes a solver of which each rank has a part. part: the root's, with all that belongs to it,
  /// but not initialized. solver: its number in the study. It must end before the team does.
  std::unique_ptr<MeshSolver<3>> shared(std::unique_ptr<MeshSolver<3>> part, std::size_t solver);

 private:
  const Ranks ranks_;
  std::unique_ptr<PoissonSolver<3>> solver_;
  std::size_t n_solvers_ = 0;  ///< made so far besides solver_, which is the next one's number
};

}  // namespace smoothfem
