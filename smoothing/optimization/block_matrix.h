// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "smoothing/mesh/compressed_rows.h"
#include "smoothing/mesh/mesh.h"
#include "smoothing/optimization/unknown_rows.h"

namespace smoothfem {

/// A vector with an entry for each row of a block matrix.
template <int dim>
using BlockVector = std::vector<Point<dim>>;

/// A symmetric sparse matrix A of dim x dim blocks, one for each pair of nodes, on a fixed pattern.
/// It is stored scaled by its diagonal blocks L L', as L^-1 A L'^-1. The scaled matrix needs no
/// preconditioner. Its blocks have the same magnitude for elements of all sizes, so that single
/// precision is enough in space. There reading blocks takes most of the time. To fill it, add up
/// the diagonal blocks, call factor_diagonal, and add the other blocks, scaled.
template <int dim>
class BlockMatrix {
 public:
  using Block = Eigen::Matrix<double, dim, dim>;  ///< columns first
  using Number = std::conditional_t<dim == 2, double, float>;

  BlockMatrix() = default;
  /// columns: those of each row, sorted ascending, with the diagonal; a symmetric pattern.
  BlockMatrix(CompressedRows<std::uint32_t> columns, UnknownRows rows);

  std::size_t n_rows() const { return columns_.size(); }
  const UnknownRows& rows() const { return rows_; }
  BlockVector<dim> make_vector() const { return BlockVector<dim>(n_rows(), Point<dim>::Zero()); }
  const CompressedRows<std::uint32_t>& columns() const { return columns_; }

  /// First step: returns diagonal blocks of zeros, one for each row, to be added to. They take over
  /// the memory of the matrix's factors.
  std::vector<Block> start_diagonal();

  /// Second step: computes the factors from these blocks, which must be positive semidefinite, and
  /// sets the other blocks to zero. Collective in a part of a mesh.
  void factor_diagonal(std::vector<Block> diagonal);
  /// Returns L^-1 of a row; zero for row number n_rows().
  const Block& inverse_factor(std::size_t row) const { return inverse_factors_[row]; }

  /// Returns the position of the block of a row and a column in columns().entries().
  std::uint32_t position(std::uint32_t row, std::uint32_t column) const {
    const auto all = columns_[row];
    const auto found = std::lower_bound(all.begin(), all.end(), column);
    assert(found != all.end() && *found == column);
    return static_cast<std::uint32_t>(columns_.offset(row) + (found - all.begin()));
  }
  /// Returns the dim x dim numbers of a scaled block, by columns.
  Number* scaled_block(std::size_t position) { return scaled_.data() + dim * dim * position; }
  const Number* scaled_block(std::size_t position) const {
    return scaled_.data() + dim * dim * position;
  }

 private:
  CompressedRows<std::uint32_t> columns_;
  UnknownRows rows_;
  std::vector<Block> inverse_factors_;  ///< L^-1 of each row
  std::vector<Number> scaled_;
};

}  // namespace smoothfem
