#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fem/manufactured_solution.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// What a finite element record measures and how (thesis, Section 6.1).
struct PoissonOptions {
  int degree = 1;                  ///< of the Lagrange elements: 1 or 2
  bool galerkin_load = false;      ///< load by quadrature in place of the thesis' nodal one
  int n_quadrilateral_points = 8;  ///< Gauss points a direction; 8 agree with the print to 0.2 %
  double cg_tolerance = 1e-8;      ///< on |r| / |b|
  /// Take the boundary values into |b|, as if their equations were identity rows of the full
  /// system.
  bool boundary_in_norm = false;
  double max_cg_iterations_per_dof = 10.0;  ///< against matrices that rounding makes singular
  bool condition_number = true;
  bool jacobi_cg = true;
};

/// The finite element numbers of one mesh: a row of the results.
struct SolutionRecord {
  int degree = 0;
  std::size_t n_dofs = 0, n_free = 0;
  double condition_number = 0.0, lambda_min = 0.0, lambda_max = 0.0;
  std::string condition_method;  ///< "none" where it was not asked for
  std::size_t cg_iterations = 0, jacobi_cg_iterations = 0;
  double cg_seconds = 0.0, jacobi_cg_seconds = 0.0;
  bool cg_converged = false;
  double e_max = 0.0, e_mean = 0.0, e_l2 = 0.0, e_h1 = 0.0;  ///< the thesis' protocol
  double l2_error = 0.0, h1_error = 0.0;                     ///< true errors by quadrature
  std::string status;  ///< "ok", or what is wrong with the numbers
};

/// Solves -laplace(u) = f with Dirichlet boundary values for meshes of one topology. What depends
/// on the topology alone is done once, at construction; copies share it, and are independent in all
/// else, so each thread takes its own.
class PoissonSolver {
 public:
  /// mesh: any mesh of the topology. Throws InputError as make_finite_element_space does.
  PoissonSolver(const PlanarMesh& mesh, const PoissonOptions& options);
  PoissonSolver(const PoissonSolver& other);
  ~PoissonSolver();

  /// mesh: of the topology given at construction, all cells valid.
  SolutionRecord solve(const PlanarMesh& mesh, const ManufacturedSolution& solution);

  /// |u - u_h| of the last solve at each mesh node; 0 at nodes that no cell uses.
  std::vector<double> nodal_errors() const;

 private:
  struct Workspace;
  PoissonOptions options_;
  std::unique_ptr<Workspace> work_;
};

}  // namespace smoothfem
