// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "smoothing/loop/problem.h"

namespace smoothfem {

/// Returns the metric in which cells should be alike to minimize the error of the gradient, for
/// second derivatives H. Source: Huang 2005, linear interpolation in the H1 seminorm. In each cell,
/// with d the dimension,
///
///   M = |A|^(2/(d+2)) det(A)^(-1/(d+2)) A,  A = alpha I + |H|.
///
/// |H| has the absolute values of the eigenvalues of H, and |A| is the norm that is 1 for I.
/// Without the first term, cells without curvature would be arbitrarily large. alpha is such that
/// the integral of sqrt(det M) is `concentration` (above 1) times its value for H = 0. So a
/// fraction 1 - 1/concentration of the cells lies where u bends. The result is scaled so that the
/// integral is the domain's size. Identity if all H are zero. sizes: of the cells, positive.
template <int dim>
std::vector<CellTensor<dim>> error_metric(std::span<const CellTensor<dim>> hessians,
                                          std::span<const double> sizes, double concentration);

}  // namespace smoothfem
