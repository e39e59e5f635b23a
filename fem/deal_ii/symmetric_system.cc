// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/deal_ii/symmetric_system.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_solver.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_MultiVector.h>
#include <Teuchos_ParameterList.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "fem/linear_algebra/condition_number.h"
#include "fem/ranks/ranks.h"
#include "smoothing/base/scoped_timer.h"

namespace smoothfem {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Matrices with more rows have an estimate of their condition number from CG. In space the factors
/// grow faster.
constexpr std::size_t most_rows_in_plane = 100000, most_rows_in_space = 10000;

/// A run of CG.
struct Run {
  double iterations = unknown;  ///< unknown if it has not converged
  double seconds = unknown;
  double condition_number = unknown;  ///< estimate, slightly low
};

template <class Matrix, class Vector, class Preconditioner>
Run run_cg(const Matrix& matrix, Vector& solution, const Vector& right_hand_side,
           const Preconditioner& preconditioner, double tolerance) {
  constexpr unsigned int iterations_per_row = 10;
  dealii::SolverControl control(iterations_per_row * matrix.m(),
                                tolerance * right_hand_side.l2_norm());
  dealii::SolverCG<Vector> cg(control);
  Run run;
  double estimate = unknown;
  cg.connect_condition_number_slot([&](double value) { estimate = value; });
  solution = 0.0;
  double seconds = 0.0;
  try {
    const ScopedTimer timer(seconds);
    cg.solve(matrix, solution, right_hand_side, preconditioner);
  } catch (const dealii::SolverControl::NoConvergence&) {
    return run;
  }
  run.seconds = seconds;
  run.iterations = control.last_step();
  run.condition_number = estimate;
  return run;
}

/// The runs without preconditioner, with Jacobi and with multigrid.
struct Runs {
  Run plain, by_jacobi, by_multigrid;
};

/// The last solution counts.
template <class Jacobi, class Matrix, class Vector>
Runs run_all(const Matrix& matrix, Vector& solution, const Vector& right_hand_side,
             const dealii::TrilinosWrappers::PreconditionAMG& multigrid, double tolerance) {
  const auto run = [&](const auto& preconditioner) {
    return run_cg(matrix, solution, right_hand_side, preconditioner, tolerance);
  };
  Jacobi jacobi;
  jacobi.initialize(matrix);
  const Runs runs{run(dealii::PreconditionIdentity()), run(jacobi), run(multigrid)};
  const bool is_solved = !std::isnan(runs.by_multigrid.iterations);
  if (!is_solved && std::isnan(runs.by_jacobi.iterations) && std::isnan(runs.plain.iterations))
    throw SolverFailure("CG does not converge, with any preconditioner");
  if (!is_solved) run(jacobi);
  return runs;
}

/// Sets multigrid up, for a near null space of the user or, without one, the constants.
void set_up_multigrid(const dealii::TrilinosWrappers::SparseMatrix& matrix,
                      const std::vector<std::vector<double>>& near_null_space,
                      dealii::TrilinosWrappers::PreconditionAMG& multigrid) {
  const dealii::TrilinosWrappers::PreconditionAMG::AdditionalData data(true, matrix.m() < 1);
  if (near_null_space.empty()) {
    multigrid.initialize(matrix, data);
    return;
  }
  Teuchos::ParameterList parameters;
  std::unique_ptr<Epetra_MultiVector> constants;
  data.set_parameters(parameters, constants, matrix);
  Epetra_MultiVector vectors(matrix.trilinos_matrix().DomainMap(),
                             static_cast<int>(near_null_space.size()));
  for (std::size_t k = 0; k < near_null_space.size(); ++k)
    std::copy(near_null_space[k].begin(), near_null_space[k].end(), vectors[static_cast<int>(k)]);
  parameters.set("null space: type", "pre-computed");
  parameters.set("null space: dimension", vectors.NumVectors());
  parameters.set("null space: vectors", vectors.Values());
  multigrid.initialize(matrix.trilinos_matrix(), parameters);
}

}  // namespace

template <int dim>
SymmetricSystem::SymmetricSystem(const LagrangeSpace<dim>& space,
                                 const dealii::AffineConstraints<double>& constrained) {
  const auto& own = space.dofs.locally_owned_dofs();
  const auto& relevant = space.relevant_dofs;
  const MPI_Comm communicator = space.dofs.get_communicator();
  dealii::DynamicSparsityPattern pattern(relevant);
  dealii::DoFTools::make_sparsity_pattern(space.dofs, pattern, constrained, false);
  dealii::SparsityTools::distribute_sparsity_pattern(pattern, own, communicator, relevant);
  if (Ranks(communicator).size() == 1) pattern_.copy_from(pattern);
  most_rows_to_factor_ = dim == 2 ? most_rows_in_plane : most_rows_in_space;
  matrix.reinit(own, own, pattern, communicator);
  right_hand_side.reinit(own, communicator);
  solution.reinit(own, relevant, communicator);
}

SymmetricSystem::SymmetricSystem(const SparseMatrix& a, const Eigen::VectorXd& b) {
  const auto n = static_cast<unsigned int>(a.rows());
  const dealii::IndexSet all = dealii::complete_index_set(n);
  dealii::DynamicSparsityPattern pattern(n);
  most_rows_to_factor_ = most_rows_in_space;
  for (int i = 0; i < a.rows(); ++i)
    for (SparseMatrix::InnerIterator entry(a, i); entry; ++entry)
      pattern.add(static_cast<unsigned int>(i), static_cast<unsigned int>(entry.col()));
  pattern_.copy_from(pattern);
  matrix.reinit(all, all, pattern, MPI_COMM_SELF);
  for (int i = 0; i < a.rows(); ++i)
    for (SparseMatrix::InnerIterator entry(a, i); entry; ++entry)
      matrix.set(static_cast<unsigned int>(i), static_cast<unsigned int>(entry.col()),
                 entry.value());
  matrix.compress(dealii::VectorOperation::insert);
  right_hand_side.reinit(all, MPI_COMM_SELF);
  solution.reinit(all, MPI_COMM_SELF);
  for (unsigned int i = 0; i < n; ++i) right_hand_side(i) = b[i];
  right_hand_side.compress(dealii::VectorOperation::insert);
}

std::vector<SolverNumber> SymmetricSystem::solve(
    const dealii::AffineConstraints<double>& constraints,
    const std::vector<std::vector<double>>& near_null_space, double tolerance) {
  const bool is_factored = matrix.m() <= most_rows_to_factor_;
  const double condition = is_factored ? condition_number(constraints) : unknown;
  if (is_factored && std::isnan(condition) && n_free(constraints) > 0)
    throw SolverFailure("the matrix is not positive definite, which CG needs");
  dealii::TrilinosWrappers::PreconditionAMG multigrid;
  double setup = 0.0;
  {
    const ScopedTimer timer(setup);
    set_up_multigrid(matrix, near_null_space, multigrid);
  }
  Runs runs;
  if (pattern_.empty()) {
    dealii::TrilinosWrappers::MPI::Vector u(right_hand_side);
    runs = run_all<dealii::TrilinosWrappers::PreconditionJacobi>(matrix, u, right_hand_side,
                                                                 multigrid, tolerance);
    constraints.distribute(u);
    solution = u;
  } else {
    using Matrix = dealii::SparseMatrix<double>;
    Matrix copy(pattern_);
    copy.copy_from(matrix);
    const dealii::Vector<double> b(right_hand_side);
    dealii::Vector<double> u(b.size());
    runs = run_all<dealii::PreconditionJacobi<Matrix>>(copy, u, b, multigrid, tolerance);
    constraints.distribute(u);
    solution = u;
  }
  return {{"n_dofs", static_cast<double>(matrix.m())},
          {"n_free", static_cast<double>(n_free(constraints))},
          {"condition_number", is_factored ? condition : runs.plain.condition_number},
          {"jacobi_condition_number", runs.by_jacobi.condition_number},
          {"cg_iterations", runs.plain.iterations},
          {"cg_seconds", runs.plain.seconds},
          {"jacobi_cg_iterations", runs.by_jacobi.iterations},
          {"jacobi_cg_seconds", runs.by_jacobi.seconds},
          {"amg_cg_iterations", runs.by_multigrid.iterations},
          {"amg_setup_seconds", setup},
          {"amg_cg_seconds", runs.by_multigrid.seconds}};
}

std::size_t SymmetricSystem::n_free(const dealii::AffineConstraints<double>& constraints) const {
  std::size_t n_own = 0;
  for (const auto dof : matrix.locally_owned_range_indices())
    if (!constraints.is_constrained(dof)) ++n_own;
  return Ranks(matrix.get_mpi_communicator()).sum(n_own);
}

void SymmetricSystem::solve_accurately(const dealii::AffineConstraints<double>& constraints,
                                       const std::vector<std::vector<double>>& near_null_space) {
  dealii::TrilinosWrappers::MPI::Vector u(right_hand_side);
  if (matrix.m() <= most_rows_to_factor_) {
    dealii::SolverControl control;
    dealii::TrilinosWrappers::SolverDirect(control).solve(matrix, u, right_hand_side);
  } else {
    constexpr double tolerance = 1e-11;
    dealii::TrilinosWrappers::PreconditionAMG multigrid;
    set_up_multigrid(matrix, near_null_space, multigrid);
    if (std::isnan(run_cg(matrix, u, right_hand_side, multigrid, tolerance).iterations))
      throw SolverFailure("CG with multigrid does not converge");
  }
  constraints.distribute(u);
  solution = u;
}

double SymmetricSystem::condition_number(
    const dealii::AffineConstraints<double>& constraints) const {
  struct Entry {
    unsigned int row, column;
    double value;
  };
  std::vector<Entry> entries;
  for (const auto row : matrix.locally_owned_range_indices())
    if (!constraints.is_constrained(row))
      for (auto entry = matrix.begin(row); entry != matrix.end(row); ++entry)
        entries.push_back({static_cast<unsigned int>(row),
                           static_cast<unsigned int>(entry->column()), entry->value()});
  const Ranks ranks(matrix.get_mpi_communicator());
  entries = ranks.gather(entries);
  double condition = unknown;
  if (!entries.empty()) {
    std::vector<int> numbers(matrix.m(), -1);
    int n_free = 0;
    for (const Entry& entry : entries)
      if (numbers[entry.row] < 0) numbers[entry.row] = n_free++;
    std::vector<Eigen::Triplet<double, int>> free_entries;
    for (const Entry& entry : entries)
      if (numbers[entry.column] >= 0)
        free_entries.emplace_back(numbers[entry.row], numbers[entry.column], entry.value);
    SparseMatrix free(n_free, n_free);
    free.setFromTriplets(free_entries.begin(), free_entries.end());
    std::vector<std::size_t> columns(static_cast<std::size_t>(n_free));
    std::iota(columns.begin(), columns.end(), 0);
    const auto found = columns.size() <= dense_limit
                           ? dense_condition_number(free, columns, columns.size(), {})
                           : CholeskyConditionNumber().compute(free);
    if (found.lambda_min > 0.0) condition = found.value();
  }
  ranks.broadcast(condition);
  return condition;
}

std::vector<NumberDescription> SymmetricSystem::descriptions() {
  return {
      {"n_dofs", "", "Number of degrees of freedom."},
      {"n_free", "", "Number of degrees of freedom without a constraint."},
      {"condition_number", "",
       "Condition number in the 2-norm of the matrix of the free dofs; above 100,000 dofs in the "
       "plane and 10,000 in space an estimate from CG, slightly low."},
      {"jacobi_condition_number", "",
       "Estimate of the condition number of the matrix scaled by its diagonal, slightly low."},
      {"cg_iterations", "", "Iterations of CG without preconditioner."},
      {"cg_seconds", "s", "Time of CG without preconditioner."},
      {"jacobi_cg_iterations", "", "Iterations of CG with Jacobi."},
      {"jacobi_cg_seconds", "s", "Time of CG with Jacobi."},
      {"amg_cg_iterations", "", "Iterations of CG with algebraic multigrid (Trilinos ML)."},
      {"amg_setup_seconds", "s", "Time to set multigrid up."},
      {"amg_cg_seconds", "s", "Time of CG with multigrid."}};
}

template SymmetricSystem::SymmetricSystem(const LagrangeSpace<2>&,
                                          const dealii::AffineConstraints<double>&);
template SymmetricSystem::SymmetricSystem(const LagrangeSpace<3>&,
                                          const dealii::AffineConstraints<double>&);

}  // namespace smoothfem
