// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/solutions/check_solution.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace smoothfem {

namespace {

/// Checks that all values are finite; outside of a formula's domain its derivatives are
/// meaningless.
template <int dim>
void check_finite(const ManufacturedSolution<dim>& s, const SolutionKeys& keys,
                  const Point<dim>& p) {
  const auto [value, gradient] = s.value_and_gradient(p);
  const char* key = !std::isfinite(value)                            ? keys.value
                    : !gradient.allFinite()                          ? keys.gradient
                    : s.diffusivity && !s.diffusivity(p).allFinite() ? "'diffusivity'"
                    : !std::isfinite(s.load(p))                      ? keys.load
                                                                     : nullptr;
  if (key != nullptr)
    throw InputError("the solution's " + std::string(key) + " is not a finite number at " +
                     point_text(p) + ", a node of the mesh: use a formula that is finite there");
  // Sums of squares must be finite, too.
  constexpr double largest = 1e100;
  const char* large = std::abs(value) > largest                  ? keys.value
                      : gradient.cwiseAbs().maxCoeff() > largest ? keys.gradient
                      : std::abs(s.load(p)) > largest            ? keys.load
                                                                 : nullptr;
  if (large != nullptr)
    throw InputError("the solution's " + std::string(large) + " is above 1e100 at " +
                     point_text(p) + ", a node of the mesh, so that errors overflow: scale it");
}

template <int dim>
void check_diffusivity(const ManufacturedSolution<dim>& s, const Point<dim>& p) {
  if (!s.diffusivity) return;
  constexpr double rounding = 1e-12;
  const Diffusivity<dim> a = s.diffusivity(p);
  const double size = a.cwiseAbs().maxCoeff();
  if (!(size >= 1e-100 && size <= 1e100))
    throw InputError("the solution's 'diffusivity' at " + point_text(p) +
                     ", a node of the mesh, is outside of 1e-100 to 1e100: scale it");
  const std::string at = " at " + point_text(p) + ", a node of the mesh: ";
  if (!((a - a.transpose()).norm() <= rounding * a.norm()))
    throw InputError("the solution's 'diffusivity' is not symmetric" + at +
                     "give the entries on both sides of the diagonal the same formula");
  const double least =
      Eigen::SelfAdjointEigenSolver<Diffusivity<dim>>(a, Eigen::EigenvaluesOnly).eigenvalues()[0];
  if (!(least > rounding * a.norm()))
    throw InputError("the solution's 'diffusivity' is not positive definite" + at +
                     "its smallest eigenvalue is " + std::to_string(least) +
                     " there and must be above 0");
}

/// A grad u
template <int dim>
Point<dim> flux_of(const ManufacturedSolution<dim>& s, const Point<dim>& p) {
  const Point<dim> gradient = s.value_and_gradient(p).gradient;
  return s.diffusivity ? Point<dim>(s.diffusivity(p) * gradient) : gradient;
}

/// Central differences at a point: of u, and minus the divergence of the flux A grad u.
template <int dim>
struct Differences {
  Point<dim> gradient;
  double load = 0.0, round_off;

  /// h: the step. of_flux: the load from differences of the given gradient; otherwise from second
  /// differences of u.
  Differences(const ManufacturedSolution<dim>& s, const Point<dim>& p, double h, bool of_flux) {
    const double u = s.value(p);
    round_off = of_flux ? 0.0 : 1e-15 * std::abs(u) / (h * h);
    for (int d = 0; d < dim; ++d) {
      const Point<dim> step = h * Point<dim>::Unit(d);
      const double ahead = s.value(p + step), behind = s.value(p - step);
      gradient[d] = (ahead - behind) / (2 * h);
      load -= of_flux ? (flux_of<dim>(s, p + step)[d] - flux_of<dim>(s, p - step)[d]) / (2 * h)
                      : (ahead + behind - 2 * u) / (h * h);
    }
  }

  static constexpr double allowed = 1e-2;
  bool fits_gradient(const Point<dim>& given) const {
    return (given - gradient).norm() <= allowed * (gradient.norm() + 1.0);
  }
  bool fits_load(double given) const {
    return std::abs(given - load) <= allowed * (std::abs(load) + 1.0) + round_off;
  }
};

/// True if a condition changes within h of the point: differences mix the pieces there.
template <int dim>
bool is_between_pieces(const ManufacturedSolution<dim>& s, const Point<dim>& p, double h) {
  if (!s.conditions) return false;
  const auto here = s.conditions(p);
  for (int d = 0; d < dim; ++d)
    for (const double step : {-h, h}) {
      const auto there = s.conditions(p + step * Point<dim>::Unit(d));
      for (std::size_t k = 0; k < here.size(); ++k)
        if (!(here[k] * there[k] > 0.0)) return true;
    }
  return false;
}

/// Step of the differences. Their error is about 1e-6 of the size of the third and fourth
/// derivatives; a wrong sign or factor gives a far larger one.
constexpr double step_of_differences = 1e-3;

template <int dim>
void check_given(const ManufacturedSolution<dim>& s, const Point<dim>& p) {
  const Differences<dim> differences(s, p, step_of_differences, bool(s.diffusivity));
  const std::string at = " at " + point_text(p);
  if (!differences.fits_gradient(s.value_and_gradient(p).gradient))
    throw InputError("the solution's gradient is not that of its value" + at +
                     ": correct 'gradient' or 'value'");
  if (!differences.fits_load(s.load(p)))
    throw InputError(std::string("the solution's load is not ") +
                     (s.diffusivity ? "-div(diffusivity grad(value))" : "-laplace(value)") + at +
                     ": there it should be near " + std::to_string(differences.load));
}

/// Checks derived gradient and load: they are correct if they fit the differences at one of the
/// steps. Formulas that change over shorter lengths need smaller steps.
template <int dim>
void check_derived(const ManufacturedSolution<dim>& s, const Point<dim>& p) {
  for (const double h :
       {step_of_differences, 1e-2 * step_of_differences, 1e-4 * step_of_differences}) {
    if (is_between_pieces(s, p, h)) continue;
    const Differences<dim> differences(s, p, h, true);
    if (differences.fits_gradient(s.value_and_gradient(p).gradient) &&
        differences.fits_load(s.load(p)))
      return;
  }
  if (!is_between_pieces(s, p, step_of_differences))
    throw InputError("the solution's 'u' changes too fast at " + point_text(p) +
                     " for its derivatives to be checked: use one that varies less");
}

}  // namespace

template <int dim>
void check_solution(const ManufacturedSolution<dim>& solution, const SolutionKeys& keys,
                    std::span<const Point<dim>> sample) {
  for (const auto& p : sample) {
    check_finite(solution, keys, p);
    check_diffusivity(solution, p);
  }
  for (const auto& p : sample)
    if (keys.is_derived)
      check_derived(solution, p);
    else
      check_given(solution, p);
}

template void check_solution(const ManufacturedSolution<2>&, const SolutionKeys&,
                             std::span<const Point<2>>);
template void check_solution(const ManufacturedSolution<3>&, const SolutionKeys&,
                             std::span<const Point<3>>);

}  // namespace smoothfem
