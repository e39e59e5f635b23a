// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear_algebra/conjugate_gradients.h"

#include <array>
#include <chrono>
#include <cmath>

#include "smoothing/base/interruption.h"
#include "smoothing/simd/lanes.h"

namespace smoothfem {

namespace {

inline double sum_of(Lanes a) {
  return (a[0] + a[1]) + (a[2] + a[3]);
}

// Each function handles the vectors of one iteration in one pass over the memory.

/// x += alpha p, r -= alpha q; returns r . r.
double update_solution(std::size_t n, double alpha, const double* p, const double* q, double* x,
                       double* r) {
  Lanes square{};
  std::size_t i = 0;
  for (; i + n_lanes <= n; i += n_lanes) {
    store_lanes(load_lanes(x + i) + alpha * load_lanes(p + i), x + i);
    const Lanes residual = load_lanes(r + i) - alpha * load_lanes(q + i);
    store_lanes(residual, r + i);
    square += residual * residual;
  }
  double sum = sum_of(square);
  for (; i < n; ++i) {
    x[i] += alpha * p[i];
    r[i] -= alpha * q[i];
    sum += r[i] * r[i];
  }
  return sum;
}

/// p = z + beta p.
void update_direction(std::size_t n, double beta, const double* z, double* p) {
  for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + beta * p[i];
}

}  // namespace

Preconditioner jacobi_preconditioner(const SlicedMatrix& matrix) {
  return [inverse = Eigen::VectorXd(matrix.diagonal().cwiseInverse())](
             const Eigen::VectorXd& r, Eigen::VectorXd& z) { z = inverse.cwiseProduct(r); };
}

ConjugateGradientsResult conjugate_gradients(const SlicedMatrix& matrix, const Eigen::VectorXd& b,
                                             Eigen::VectorXd& x,
                                             const ConjugateGradientsOptions& options,
                                             const Preconditioner& preconditioner) {
  using Clock = std::chrono::steady_clock;
  const auto started = Clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(Clock::now() - started).count();
  };
  const Ranks& ranks = matrix.ranks();
  const auto n = static_cast<std::size_t>(matrix.n_rows());

  ConjugateGradientsResult result;
  x = Eigen::VectorXd::Zero(matrix.n_columns());
  Eigen::VectorXd r = b, z = b, q(b.size()), p = x;
  if (preconditioner) preconditioner(r, z);
  p.head(b.size()) = z;
  std::array start{r.squaredNorm(), r.dot(z)};
  ranks.sum(start);
  double residual = start[0], rho = start[1], previous_alpha = 0.0, beta = 0.0;
  const double goal = options.tolerance * options.tolerance * (residual + options.norm_offset);
  bool out_of_time = false, indefinite = false;
  while (residual > goal && result.iterations < options.max_iterations && !out_of_time) {
    let_interrupt();
    const double curvature = ranks.sum(matrix.multiply(p, q));
    if (options.stop_if_indefinite && !(curvature > 0.0 && rho > 0.0)) {
      indefinite = true;
      break;
    }
    const double alpha = rho / curvature;
    ++result.iterations;
    // T_kk = 1/alpha_k + beta_{k-1}/alpha_{k-1}, T_k,k+1 = sqrt(beta_k)/alpha_k.
    result.lanczos.diagonal.push_back(1.0 / alpha +
                                      (previous_alpha > 0.0 ? beta / previous_alpha : 0.0));
    const double square = update_solution(n, alpha, p.data(), q.data(), x.data(), r.data());
    if (preconditioner) preconditioner(r, z);
    // The root's clock counts, so that all ranks stop together.
    std::array sums{square, preconditioner ? r.dot(z) : square,
                    ranks.is_root() && seconds() > options.max_seconds ? 1.0 : 0.0};
    ranks.sum(sums);
    residual = sums[0];
    beta = sums[1] / rho;
    rho = sums[1];
    out_of_time = sums[2] > 0.0;
    result.lanczos.off_diagonal.push_back(std::sqrt(beta) / alpha);
    update_direction(n, beta, preconditioner ? z.data() : r.data(), p.data());
    previous_alpha = alpha;
  }
  matrix.halo().update(x);
  result.end = !(residual > goal) ? ConjugateGradientsEnd::converged
               : indefinite       ? ConjugateGradientsEnd::indefinite
               : out_of_time      ? ConjugateGradientsEnd::time_limit
                                  : ConjugateGradientsEnd::iteration_limit;
  result.seconds = seconds();
  return result;
}

}  // namespace smoothfem
