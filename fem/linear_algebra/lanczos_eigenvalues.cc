// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear_algebra/lanczos_eigenvalues.h"

#include <cmath>

extern "C" {
/// LAPACK: selected eigenvalues and vectors of a symmetric tridiagonal matrix, by bisection and
/// inverse iteration.
void dstevx_(const char* jobz, const char* range, const int* n, double* d, double* e,
             const double* vl, const double* vu, const int* il, const int* iu, const double* abstol,
             int* m, double* w, double* z, const int* ldz, double* work, int* iwork, int* ifail,
             int* info);
}

namespace smoothfem {

namespace {

/// index: 1 for the smallest.
RitzValue ritz_value(const LanczosMatrix& matrix, int index) {
  const int n = static_cast<int>(matrix.diagonal.size());
  auto diagonal = matrix.diagonal;
  auto off_diagonal = matrix.off_diagonal;
  const auto size = static_cast<std::size_t>(n);
  std::vector<double> vector(size), work(5 * size), values(size);
  std::vector<int> integers(5 * size), failed(size);
  const double unused = 0.0, best_accuracy = 0.0;
  int n_found = 0, info = 0;
  dstevx_("V", "I", &n, diagonal.data(), off_diagonal.data(), &unused, &unused, &index, &index,
          &best_accuracy, &n_found, values.data(), vector.data(), &n, work.data(), integers.data(),
          failed.data(), &info);
  if (n_found != 1) return {};
  const double last = matrix.off_diagonal.back() * vector.back();
  return {values[0], info == 0 ? std::abs(last) / values[0] : 1.0};
}

}  // namespace

ExtremeRitzValues extreme_ritz_values(const LanczosMatrix& matrix) {
  return {ritz_value(matrix, 1), ritz_value(matrix, static_cast<int>(matrix.diagonal.size()))};
}

}  // namespace smoothfem
