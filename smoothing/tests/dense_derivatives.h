// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "smoothing/loop/smooth.h"
#include "smoothing/optimization/shape_objective.h"

namespace smoothfem::test {

struct DenseDerivatives {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};

template <int dim>
Eigen::MatrixXd dense_matrix(const BlockMatrix<dim>& matrix) {
  const auto n = static_cast<Eigen::Index>(dim * matrix.n_rows());
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  const auto factor = [&](std::size_t row) -> Eigen::Matrix<double, dim, dim> {
    return matrix.inverse_factor(row).inverse();
  };
  for (std::uint32_t row = 0; row < matrix.n_rows(); ++row)
    for (std::size_t k = matrix.columns().offset(row); k < matrix.columns().offset(row + 1); ++k) {
      const auto column = matrix.columns().entries()[k];
      const Eigen::Map<const Eigen::Matrix<typename BlockMatrix<dim>::Number, dim, dim>> scaled(
          matrix.scaled_block(k));
      dense.template block<dim, dim>(dim * row, dim * column) =
          factor(row) * scaled.template cast<double>() * factor(column).transpose();
    }
  return dense;
}

/// objective: a ShapeObjective or a CurvedObjective.
template <class Objective, int dim>
DenseDerivatives dense_derivatives(Objective& objective, const Mesh<dim>& mesh,
                                   HessianModel model) {
  BlockMatrix<dim> matrix = objective.make_hessian();
  BlockVector<dim> gradient = matrix.make_vector();
  objective.derivatives(mesh.coordinates(), model, gradient, matrix);
  DenseDerivatives result{Eigen::VectorXd(dim * gradient.size()), dense_matrix(matrix)};
  for (std::size_t i = 0; i < gradient.size(); ++i)
    result.gradient.template segment<dim>(static_cast<Eigen::Index>(dim * i)) = gradient[i];
  return result;
}

/// Checks that global optimization of the mesh lowers the objective in every iteration, to a
/// minimum.
template <int dim>
void expect_descent_to_a_stationary_point(Mesh<dim> mesh) {
  ShapeObjective<dim> objective(mesh.shared_topology());
  Method<dim> method = make_method<dim>("global-optimization");
  method.set("tolerance", "1e-13");
  double last = objective.value(mesh.coordinates());
  smooth(mesh, method, [&](const IterationRecord&, const Mesh<dim>& seen) {
    const double value = objective.value(seen.coordinates());
    EXPECT_LE(value, last);
    last = value;
  });
  const auto exact = dense_derivatives(objective, mesh, HessianModel::exact);
  EXPECT_LT(exact.gradient.norm(), 1e-5 * exact.hessian.norm());
  const Eigen::VectorXd eigenvalues =
      exact.hessian.template selfadjointView<Eigen::Lower>().eigenvalues();
  EXPECT_GT(eigenvalues.minCoeff(), 0.0);
}

}  // namespace smoothfem::test
