// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "smoothing/loop/problem.h"

namespace smoothfem {

/// The metric in which all cells should be alike, for the gradient's error to be least where a
/// function has these second derivatives H (Huang 2005, for linear interpolation in the H1
/// seminorm; d the dimension): in each cell
///   M = |A|^(2/(d+2)) det(A)^(-1/(d+2)) A,  A = alpha I + |H|,
/// |H| with the absolute values of the eigenvalues of H, |A| the norm that is 1 for I. Without the
/// first term cells without curvature would be as large as they like: alpha is such that the
/// integral of sqrt(det M) is `concentration` (above 1) times that where H is zero, so that a
/// fraction 1 - 1/concentration of the cells is where u bends. Scaled so that the integral is the
/// domain's size. Identity if all H are zero. sizes: of the cells, positive.
template <int dim>
std::vector<CellTensor<dim>> error_metric(std::span<const CellTensor<dim>> hessians,
                                          std::span<const double> sizes, double concentration);

}  // namespace smoothfem
