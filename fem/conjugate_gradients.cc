#include "fem/conjugate_gradients.h"

#include <chrono>
#include <cmath>

namespace smoothfem {

ConjugateGradientsResult conjugate_gradients(const SlicedMatrix& matrix, const Eigen::VectorXd& b,
                                             Eigen::VectorXd& x, double tolerance,
                                             std::size_t max_iterations,
                                             Preconditioner preconditioner, double norm_offset) {
  using Clock = std::chrono::steady_clock;
  const auto started = Clock::now();
  const bool jacobi = preconditioner == Preconditioner::jacobi;
  Eigen::VectorXd inverse_diagonal;
  if (jacobi) inverse_diagonal = matrix.diagonal().cwiseInverse();

  ConjugateGradientsResult result;
  const double goal = tolerance * tolerance * (b.squaredNorm() + norm_offset);
  x = Eigen::VectorXd::Zero(b.size());
  Eigen::VectorXd r = b, z = r, product(b.size());
  if (jacobi) z = inverse_diagonal.cwiseProduct(r);
  Eigen::VectorXd p = z;
  double rho = r.dot(z), previous_alpha = 0.0, beta = 0.0;
  double residual = r.squaredNorm();
  while (residual > goal && result.iterations < max_iterations) {
    matrix.multiply(p, product);
    const double alpha = rho / p.dot(product);
    x += alpha * p;
    r -= alpha * product;
    ++result.iterations;
    // Lanczos: T_kk = 1/alpha_k + beta_{k-1}/alpha_{k-1}, T_k,k+1 = sqrt(beta_k)/alpha_k.
    result.lanczos_diagonal.push_back(1.0 / alpha +
                                      (previous_alpha > 0.0 ? beta / previous_alpha : 0.0));
    residual = r.squaredNorm();
    if (jacobi) z = inverse_diagonal.cwiseProduct(r);
    const double rho_new = jacobi ? r.dot(z) : residual;
    beta = rho_new / rho;
    result.lanczos_off_diagonal.push_back(std::sqrt(beta) / alpha);
    if (jacobi)
      p = z + beta * p;
    else
      p = r + beta * p;
    rho = rho_new;
    previous_alpha = alpha;
  }
  result.converged = residual <= goal;
  result.seconds = std::chrono::duration<double>(Clock::now() - started).count();
  return result;
}

}  // namespace smoothfem
