// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/solution/error_metric.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace smoothfem {

namespace {

template <int dim>
CellTensor<dim> absolute(const CellTensor<dim>& h) {
  const Eigen::SelfAdjointEigenSolver<CellTensor<dim>> eigen(h);
  const CellTensor<dim> turned = eigen.eigenvectors() * eigen.eigenvalues().cwiseAbs().asDiagonal();
  return turned * eigen.eigenvectors().transpose();
}

template <int dim>
CellTensor<dim> metric_of(const CellTensor<dim>& absolute_hessian, double alpha) {
  constexpr double exponent = 1.0 / (dim + 2);
  const CellTensor<dim> a = alpha * CellTensor<dim>::Identity() + absolute_hessian;
  const double square = a.squaredNorm() / dim;
  return std::pow(square / a.determinant(), exponent) * a;
}

/// Integral of sqrt(det M), relative to that of sqrt(det(alpha I)).
template <int dim>
double relative_size(const std::vector<CellTensor<dim>>& absolute_hessians,
                     std::span<const double> sizes, double alpha) {
  double sum = 0.0, total = 0.0;
  for (std::size_t c = 0; c < sizes.size(); ++c) {
    sum += sizes[c] * std::sqrt(metric_of<dim>(absolute_hessians[c], alpha).determinant());
    total += sizes[c];
  }
  return sum / (total * std::pow(alpha, 0.5 * dim));
}

}  // namespace

template <int dim>
std::vector<CellTensor<dim>> error_metric(std::span<const CellTensor<dim>> hessians,
                                          std::span<const double> sizes, double concentration) {
  std::vector<CellTensor<dim>> metric;
  double largest = 0.0;
  for (const CellTensor<dim>& h : hessians) {
    metric.push_back(absolute<dim>(h));
    largest = std::max(largest, metric.back().norm());
  }
  if (!(largest > 0.0))
    return std::vector<CellTensor<dim>>(hessians.size(), CellTensor<dim>::Identity());
  double lower = std::log(1e-9 * largest), upper = std::log(1e9 * largest);
  constexpr int n_halvings = 60;
  for (int k = 0; k < n_halvings; ++k) {
    const double middle = 0.5 * (lower + upper);
    (relative_size<dim>(metric, sizes, std::exp(middle)) > concentration ? lower : upper) = middle;
  }
  const double alpha = std::exp(upper);
  const double scale = std::pow(relative_size<dim>(metric, sizes, alpha), -2.0 / dim) / alpha;
  for (CellTensor<dim>& m : metric) m = scale * metric_of<dim>(m, alpha);
  return metric;
}

template std::vector<CellTensor<2>> error_metric<2>(std::span<const CellTensor<2>>,
                                                    std::span<const double>, double);
template std::vector<CellTensor<3>> error_metric<3>(std::span<const CellTensor<3>>,
                                                    std::span<const double>, double);

}  // namespace smoothfem
