// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear_algebra/trilinos_matrix.h"

#include <Epetra_CrsGraph.h>
#include <Epetra_CrsMatrix.h>
#include <Epetra_InvOperator.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_MultiVector.h>
#include <Epetra_Vector.h>
#include <ml_MultiLevelPreconditioner.h>
#include <ml_utils.h>
#include <AnasaziBasicEigenproblem.hpp>
#include <AnasaziBlockKrylovSchurSolMgr.hpp>
#include <AnasaziEpetraAdapter.hpp>
#include <AnasaziLOBPCGSolMgr.hpp>

namespace smoothfem {

struct TrilinosMatrix::Trilinos {
  Epetra_MpiComm comm;
  Epetra_Map rows, columns;
  Epetra_CrsMatrix matrix;
  std::unique_ptr<ML_Epetra::MultiLevelPreconditioner> hierarchy;

  Trilinos(const Ranks& ranks, std::size_t n_free, std::vector<int> numbers,
           const SparsityPattern& pattern)
      : comm(ranks.communicator()),
        rows(static_cast<int>(n_free), static_cast<int>(pattern.n_rows()), numbers.data(), 0, comm),
        columns(-1, static_cast<int>(numbers.size()), numbers.data(), 0, comm),
        matrix(Copy, graph_of(pattern)) {
    matrix.FillComplete(rows, rows);
    matrix.OptimizeStorage();
  }

 private:
  Epetra_CrsGraph graph_of(const SparsityPattern& pattern) const {
    std::vector<int> lengths;
    lengths.reserve(pattern.n_rows());
    const auto& starts = pattern.starts;
    for (std::size_t i = 0; i < pattern.n_rows(); ++i) lengths.push_back(starts[i + 1] - starts[i]);
    Epetra_CrsGraph graph(Copy, rows, columns, lengths.data(), true);
    for (std::size_t i = 0; i < pattern.n_rows(); ++i)
      graph.InsertMyIndices(static_cast<int>(i), lengths[i],
                            const_cast<int*>(pattern.columns.data()) + starts[i]);
    graph.FillComplete(rows, rows);
    graph.OptimizeStorage();
    return graph;
  }
};

template <int dim>
TrilinosMatrix::TrilinosMatrix(const FiniteElementSpace<dim>& space) {
  std::vector<int> numbers(space.column_numbers.begin(), space.column_numbers.end());
  trilinos_ =
      std::make_unique<Trilinos>(space.ranks, space.n_free, std::move(numbers), space.pattern);
}
template TrilinosMatrix::TrilinosMatrix(const FiniteElementSpace<2>&);
template TrilinosMatrix::TrilinosMatrix(const FiniteElementSpace<3>&);

TrilinosMatrix::~TrilinosMatrix() = default;

void TrilinosMatrix::set_values(const SparseMatrix& matrix) {
  int *starts = nullptr, *columns = nullptr;
  double* values = nullptr;
  trilinos_->matrix.ExtractCrsDataPointers(starts, columns, values);
  // Rows and columns have the same order in both, and so do the values.
  std::copy(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros(), values);
}

void TrilinosMatrix::set_up_multigrid() {
  Teuchos::ParameterList parameters;
  ML_Epetra::SetDefaults("SA", parameters);
  parameters.set("ML output", 0);
  // Gauss-Seidel, the default, works on each rank separately. The cycle would then depend on the
  // number of ranks, and might not be positive definite.
  parameters.set("smoother: type", "Chebyshev");
  parameters.set("smoother: sweeps", 2);
  trilinos_->hierarchy.reset();
  // Estimates of eigenvalues start from random vectors. With a common sequence of random numbers,
  // the hierarchy would depend on the earlier matrices.
  ML_set_random_seed(1);
  trilinos_->hierarchy =
      std::make_unique<ML_Epetra::MultiLevelPreconditioner>(trilinos_->matrix, parameters, true);
}

void TrilinosMatrix::apply_multigrid(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
  const Epetra_Vector in(View, trilinos_->rows, const_cast<double*>(r.data()));
  Epetra_Vector out(View, trilinos_->rows, z.data());
  trilinos_->hierarchy->ApplyInverse(in, out);
}

namespace {

using Vectors = Epetra_MultiVector;
using Operator = Epetra_Operator;
using Problem = Anasazi::BasicEigenproblem<double, Vectors, Operator>;

/// Vector with a component along every eigenvector; the same for every number of ranks.
Vectors generic_vector(const Epetra_CrsMatrix& matrix) {
  Vectors vector(matrix.RowMap(), 1);
  for (int i = 0; i < vector.MyLength(); ++i)
    vector[0][i] = 0.5 + std::fmod(0.6180339887498949 * matrix.RowMap().GID(i), 1.0);
  return vector;
}

/// Makes an eigenvalue problem. A start close to an eigenvector would stay at its eigenvalue even
/// after another one has become extreme (another cell is the worst now). So the start gets a
/// component along `generic`.
Teuchos::RCP<Problem> make_problem(const Epetra_CrsMatrix& matrix, const Eigen::VectorXd& start,
                                   const Vectors& generic) {
  constexpr double generic_fraction = 1e-2;
  const auto vector = Teuchos::rcp(new Vectors(generic));
  bool given = start.size() > 0;
  double norm = 0.0, generic_norm = 0.0;
  if (given) std::copy(start.begin(), start.end(), (*vector)[0]);
  vector->Norm2(&norm);
  generic.Norm2(&generic_norm);
  if (given && norm > 0.0) vector->Update(generic_fraction / generic_norm, generic, 1.0 / norm);
  const auto problem =
      Teuchos::rcp(new Problem(Teuchos::rcpFromRef<const Operator>(matrix), vector));
  problem->setHermitian(true);
  problem->setNEV(1);
  return problem;
}

/// Checks a pair by its vector, as Anasazi sometimes reports convergence wrongly.
Eigenpair checked(const Epetra_CrsMatrix& matrix, const Problem& problem) {
  Eigenpair pair;
  const auto& solution = problem.getSolution();
  if (solution.numVecs < 1) return pair;
  const Vectors& x = *solution.Evecs;
  Vectors product(matrix.RowMap(), 1);
  matrix.Apply(x, product);
  double square = 0.0, residual = 0.0;
  x.Dot(x, &square);
  product.Dot(x, &pair.value);
  pair.value /= square;
  product.Update(-pair.value, x, 1.0);
  product.Norm2(&residual);
  pair.residual = residual / (std::sqrt(square) * pair.value);
  pair.vector = Eigen::Map<const Eigen::VectorXd>(x[0], x.MyLength());
  return pair;
}

}  // namespace

Eigenpair TrilinosMatrix::smallest_eigenpair(const Eigen::VectorXd& start, double tolerance) const {
  constexpr int max_iterations = 5000;  // distorted meshes take hundreds
  const Vectors rough = generic_vector(trilinos_->matrix);
  Vectors generic(rough);  // smooth, like the wanted eigenvector
  trilinos_->hierarchy->ApplyInverse(rough, generic);
  const auto problem = make_problem(trilinos_->matrix, start, generic);
  const Epetra_InvOperator inverse(trilinos_->hierarchy.get());
  problem->setPrec(Teuchos::rcpFromRef<const Operator>(inverse));
  problem->setProblem();
  Teuchos::ParameterList parameters;
  parameters.set("Which", "SR");
  parameters.set("Block Size", 1);
  parameters.set("Maximum Iterations", max_iterations);
  parameters.set("Convergence Tolerance", tolerance);
  parameters.set("Relative Convergence Tolerance", true);
  parameters.set("Full Ortho", true);
  parameters.set("Verbosity", static_cast<int>(Anasazi::Errors));
  Anasazi::LOBPCGSolMgr<double, Vectors, Operator>(problem, parameters).solve();
  return checked(trilinos_->matrix, *problem);
}

Eigenpair TrilinosMatrix::largest_eigenpair(const Eigen::VectorXd& start, double tolerance) const {
  const auto problem = make_problem(trilinos_->matrix, start, generic_vector(trilinos_->matrix));
  problem->setProblem();
  Teuchos::ParameterList parameters;
  parameters.set("Which", "LR");
  parameters.set("Block Size", 1);
  parameters.set("Num Blocks", 24);
  parameters.set("Maximum Restarts", 50);
  parameters.set("Convergence Tolerance", tolerance);
  parameters.set("Relative Convergence Tolerance", true);
  parameters.set("Verbosity", static_cast<int>(Anasazi::Errors));
  Anasazi::BlockKrylovSchurSolMgr<double, Vectors, Operator>(problem, parameters).solve();
  return checked(trilinos_->matrix, *problem);
}

}  // namespace smoothfem
