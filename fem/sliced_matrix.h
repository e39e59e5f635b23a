#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fem/finite_element_space.h"

namespace smoothfem {

/// A sparse matrix laid out for fast products: n_lanes rows of similar length at a time (sliced
/// ELLPACK). Rows of finite element matrices are so short that a product row by row waits for its
/// own sums; this one is about twice as fast, and adds up each row in the order of its columns.
class SlicedMatrix {
 public:
  /// Takes pattern and values.
  explicit SlicedMatrix(const SparseMatrix& matrix);

  /// Takes the values of a matrix with the same pattern.
  void set_values(const SparseMatrix& matrix);

  Eigen::Index size() const { return size_; }
  const Eigen::VectorXd& diagonal() const { return diagonal_; }

  /// y = A x; sizes as the matrix, no overlap.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;

 private:
  Eigen::Index size_;
  std::vector<std::uint32_t> rows_;     ///< the rows of each slice; padding repeats the last row
  std::vector<std::size_t> offsets_;    ///< where each slice begins in the arrays below
  std::vector<std::uint32_t> columns_;  ///< lane by lane; padding points at column 0
  std::vector<std::uint32_t> places_;   ///< of each entry in the matrix' values, or `padding`
  std::vector<double> values_;          ///< padding is zero
  Eigen::VectorXd diagonal_;
};

}  // namespace smoothfem
