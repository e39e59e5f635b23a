// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fem/ranks/ranks.h"
#include "fem/space/finite_element_space.h"

namespace smoothfem {

/// This rank's rows of a square sparse matrix in a layout for fast products: n_lanes rows of
/// similar length at a time (sliced ELLPACK). Rows of finite element matrices are so short that a
/// product row by row waits for its sums. On one core this layout is 1.2 times (degree 2,
/// hexahedra) to 1.8 times (degree 1, tetrahedra) as fast (fem_bench, product). Each row is added
/// up in the order of its columns.
class SlicedMatrix {
 public:
  /// Takes pattern and values. matrix: rows of this rank, with the columns of `halo`.
  explicit SlicedMatrix(const SparseMatrix& matrix, const Ranks& ranks = {}, const Halo& halo = {});

  /// Takes the values of a matrix with the same pattern.
  void set_values(const SparseMatrix& matrix);

  Eigen::Index n_rows() const { return n_rows_; }
  Eigen::Index n_columns() const { return n_columns_; }
  const Ranks& ranks() const { return ranks_; }
  const Halo& halo() const { return halo_; }
  const Eigen::VectorXd& diagonal() const { return diagonal_; }

  /// Computes y = A x. x: n_columns entries; those of other ranks are fetched here. y: n_rows
  /// entries, no overlap. Returns this rank's part of x . y. Collective.
  double multiply(Eigen::VectorXd& x, Eigen::VectorXd& y) const;

 private:
  double multiply_rows(const double* x, double* y) const;

  Ranks ranks_;
  Halo halo_;
  Eigen::Index n_rows_, n_columns_;
  std::vector<std::uint32_t> rows_;     ///< the rows of each slice; padding repeats the last row
  std::vector<std::size_t> offsets_;    ///< begin of each slice in the arrays below
  std::vector<std::uint32_t> columns_;  ///< lane by lane; padding refers to column 0
  std::vector<double> values_;          ///< padding is zero
  Eigen::VectorXd diagonal_;
};

}  // namespace smoothfem
