// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "fem/assembly/load.h"
#include "fem/solution_record.h"
#include "fem/solutions/manufactured_solution.h"
#include "fem/space/finite_element_space.h"

namespace smoothfem {

/// Meshes of a study for which a number is computed.
enum class Recorded { never, results, always };

/// Method for the condition numbers of records.
enum class ConditionNumberMethod {
  none,
  lanczos,  ///< from the Lanczos numbers of the CG run: costs nothing, slightly low
  verified  ///< eigenpairs whose residuals are recomputed
};

/// Contents and method of a finite element record (thesis, Section 6.1).
struct PoissonOptions {
  int degree = 1;  ///< of the Lagrange elements: 1 or 2
  Geometry geometry = Geometry::curved;
  Load load = Load::quadrature;
  std::vector<std::string> natural_groups{};  ///< see make_finite_element_space
  std::shared_ptr<const NodeTies> ties{};     ///< on the root; null: none
  TensorPoints tensor_points{};
  double cg_tolerance = 1e-8;  ///< for |r| / |b|
  /// Include the boundary values in |b|, as if their equations were identity rows of the full
  /// system.
  bool boundary_in_norm = false;
  double max_cg_iterations_per_dof = 10.0;  ///< limit for matrices that rounding makes singular
  double max_cg_seconds = std::numeric_limits<double>::infinity();  ///< of each run of CG
  /// For every record. Initial and resulting meshes have verified condition numbers unless it is
  /// `none`.
  ConditionNumberMethod condition_number = ConditionNumberMethod::verified;
  Recorded jacobi_cg = Recorded::always;
  Recorded multigrid_cg = Recorded::never;
  Recorded best_approximation = Recorded::never;  ///< errors of the best approximations to u
};

/// A finite element function u_h, and how far it is from u.
template <int dim>
struct DiscreteSolution {
  std::vector<Point<dim>> dof_points;  ///< positions of the dofs
  std::vector<double> dof_values;      ///< u_h there
  /// u_h at each mesh node; NaN at nodes that no cell uses, and at midside nodes if the geometry is
  /// straight.
  std::vector<double> node_values;
  std::vector<ErrorOnCell> cell_errors;  ///< norms of u - u_h on each cell of the mesh
};

/// Solves -div(A grad u) = f for meshes of one topology, with Dirichlet boundary values, and
/// natural ones on the groups of the options. Computations that depend on the topology alone are
/// done once, at construction. Copies share their results and are otherwise independent, so that
/// each thread takes its own copy. Several processes share the work; all calls are collective.
template <int dim>
class PoissonSolver {
 public:
  /// mesh: any mesh of the topology, on the root; null elsewhere. Or each rank's part of a mesh
  /// that no rank has as a whole (smoothing/parts/mesh_part.h): ranks then share equations as they
  /// share nodes. Throws InputError as make_finite_element_space does.
  PoissonSolver(const Mesh<dim>* mesh, const PoissonOptions& options, const Ranks& ranks = {});
  PoissonSolver(const PoissonSolver& other);
  ~PoissonSolver();

  /// Solves on a mesh. coordinates: on the root, of all nodes of a mesh of the topology with valid
  /// cells; in parts, of all nodes of each rank's part. is_result: true for an initial or resulting
  /// mesh of a study, with all that is recorded for it. Throws CellError for curved cells that are
  /// folded inside.
  SolutionRecord solve(std::span<const Point<dim>> coordinates,
                       const ManufacturedSolution<dim>& solution, bool is_result = true);

  /// Returns, on the root, |u - u_h| of the last solve at each mesh node; 0 at nodes where
  /// node_values is NaN. In parts, on each rank at the nodes of its part. Collective.
  std::vector<double> nodal_errors() const;

  /// Returns the last solution. mesh, solution: those of the last solve. For one process only.
  DiscreteSolution<dim> discrete_solution(const Mesh<dim>& mesh,
                                          const ManufacturedSolution<dim>& solution) const;

  /// Returns, on the root, the start vectors of the next verified condition number; empty if there
  /// are none. Their order depends on the number of ranks. Collective.
  std::vector<double> eigenvectors() const;
  /// Sets the start vectors. eigenvectors: on the root, of a solver for the same topology, degree
  /// and number of ranks; vectors of another size are ignored. Collective.
  void set_eigenvectors(const std::vector<double>& eigenvectors);

 private:
  struct Workspace;
  PoissonOptions options_;
  std::unique_ptr<Workspace> work_;
};

}  // namespace smoothfem
