// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "fem/solution_record.h"
#include "fem/solutions/manufactured_solution.h"
#include "fem/space/finite_element_space.h"

namespace smoothfem {

/// For which meshes of a study something is computed.
enum class Recorded { never, results, always };

/// How condition numbers of records come about.
enum class ConditionNumberMethod {
  none,
  lanczos,  ///< from the Lanczos numbers of the CG run: costs nothing, a little low
  verified  ///< eigenpairs whose residuals are recomputed
};

/// What a finite element record measures and how (thesis, Section 6.1).
struct PoissonOptions {
  int degree = 1;              ///< of the Lagrange elements: 1 or 2
  bool galerkin_load = false;  ///< load by quadrature in place of the thesis' nodal one
  std::vector<std::string> natural_groups{};  ///< see make_finite_element_space
  TensorPoints tensor_points{};
  double cg_tolerance = 1e-8;  ///< on |r| / |b|
  /// Take the boundary values into |b|, as if their equations were identity rows of the full
  /// system.
  bool boundary_in_norm = false;
  double max_cg_iterations_per_dof = 10.0;  ///< against matrices that rounding makes singular
  double max_cg_seconds = std::numeric_limits<double>::infinity();  ///< of each run of CG
  /// Of every record; initial and resulting meshes have verified ones unless it is none.
  ConditionNumberMethod condition_number = ConditionNumberMethod::verified;
  Recorded jacobi_cg = Recorded::always;
  Recorded multigrid_cg = Recorded::never;
};

/// Solves -div(A grad u) = f with Dirichlet boundary values, and natural ones on the groups of the
/// options, for meshes of one topology. What depends
/// on the topology alone is done once, at construction; copies share it, and are independent in all
/// else, so each thread takes its own. Several processes share the work; all calls are collective.
template <int dim>
class PoissonSolver {
 public:
  /// mesh: any mesh of the topology, on the root; null elsewhere. Throws InputError as
  /// make_finite_element_space does.
  PoissonSolver(const Mesh<dim>* mesh, const PoissonOptions& options, const Ranks& ranks = {});
  PoissonSolver(const PoissonSolver& other);
  ~PoissonSolver();

  /// coordinates: on the root, of all nodes of a mesh of the topology, all of whose cells are
  /// valid. is_result: an initial or resulting mesh of a study, with all that is recorded for
  /// those.
  SolutionRecord solve(std::span<const Point<dim>> coordinates,
                       const ManufacturedSolution<dim>& solution, bool is_result = true);

  /// On the root: |u - u_h| of the last solve at each mesh node; 0 at nodes that no cell uses.
  /// Collective.
  std::vector<double> nodal_errors() const;

  /// On the root: what the next verified condition number starts from; empty if it starts from
  /// nothing. Its order depends on the number of ranks. Collective.
  std::vector<double> eigenvectors() const;
  /// eigenvectors: on the root, of a solver for the same topology, degree and number of ranks; of
  /// another size they are ignored. Collective.
  void set_eigenvectors(const std::vector<double>& eigenvectors);

 private:
  struct Workspace;
  PoissonOptions options_;
  std::unique_ptr<Workspace> work_;
};

}  // namespace smoothfem
