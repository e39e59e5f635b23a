// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/second_order/jacobian_bounds.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace smoothfem {

namespace {

using Coefficients = std::span<const double>;

double least(Coefficients coefficients) {
  return *std::min_element(coefficients.begin(), coefficients.end());
}

double least_corner(const BernsteinSpace& space, Coefficients coefficients) {
  double value = coefficients[0];
  for (const std::size_t corner : space.corners()) value = std::min(value, coefficients[corner]);
  return value;
}

double largest_absolute(Coefficients coefficients) {
  double value = 0.0;
  for (const double c : coefficients) value = std::max(value, std::abs(c));
  return value;
}

/// Bounds the minimum of a polynomial until suffices(bounds).
template <class Suffices>
Interval bound_minimum(const BernsteinSpace& space, Coefficients whole, const Suffices& suffices) {
  Interval bounds{least(whole), least_corner(space, whole)};
  if (suffices(bounds)) return bounds;

  struct Part {
    double lower;
    std::size_t first;  ///< position of its coefficients
    /// The heap's first part has the lowest bound.
    bool operator<(const Part& other) const { return lower > other.lower; }
  };
  std::vector<Part> heap{{bounds.lower, 0}};
  std::vector<double> all(whole.begin(), whole.end());
  const std::size_t n = space.size();
  for (int i = 0; i < max_bisections && !suffices(bounds); ++i) {
    std::pop_heap(heap.begin(), heap.end());
    const std::size_t old = heap.back().first, added = all.size();
    heap.pop_back();
    all.resize(added + n);
    const std::span<double> first(all.data() + old, n), second(all.data() + added, n);
    space.bisect(space.best_split(first), first, first, second);
    for (const auto& half : {first, second}) {
      heap.push_back({least(half), static_cast<std::size_t>(half.data() - all.data())});
      std::push_heap(heap.begin(), heap.end());
      bounds.upper = std::min(bounds.upper, least_corner(space, half));
    }
    bounds.lower = heap.front().lower;
  }
  return bounds;
}

/// Bound of the rounding errors of all coefficients in bound_minimum().
template <int dim>
double bisection_error(const JacobianPolynomial<dim>& jacobian) {
  return jacobian.error() + max_bisections * jacobian.space().bisection_steps() * 0x1p-53 *
                                largest_absolute(jacobian.coefficients());
}

}  // namespace

template <int dim>
bool is_proven_valid(const JacobianPolynomial<dim>& jacobian) {
  const double error = bisection_error(jacobian);
  const auto decided = [error](const Interval& minimum) {
    return minimum.lower > error || minimum.upper <= error;
  };
  return bound_minimum(jacobian.space(), jacobian.coefficients(), decided).lower > error;
}

template <int dim>
bool is_proven_valid(std::span<const Point<dim>> points) {
  return is_proven_valid(JacobianPolynomial<dim>(points));
}

template <int dim>
JacobianBounds jacobian_bounds(const JacobianPolynomial<dim>& jacobian, double tolerance) {
  const Coefficients coefficients = jacobian.coefficients();
  const double error = bisection_error(jacobian);
  // Largest |det J| at a point where it is known.
  double largest = 0.0;
  for (const std::size_t corner : jacobian.space().corners())
    largest = std::max(largest, std::abs(coefficients[corner]));
  const auto suffices = [&](const Interval& bounds) {
    largest = std::max(largest, std::abs(bounds.upper));
    return bounds.upper - bounds.lower <= std::max(tolerance * largest, error);
  };
  const auto minimum_of = [&](Coefficients whole) {
    const Interval bounds = bound_minimum(jacobian.space(), whole, suffices);
    return Interval{bounds.lower - error, bounds.upper + error};
  };
  std::vector<double> negative(coefficients.size());
  std::transform(coefficients.begin(), coefficients.end(), negative.begin(), std::negate<>());
  const Interval minimum = minimum_of(coefficients), negative_maximum = minimum_of(negative);
  return {minimum, {-negative_maximum.upper, -negative_maximum.lower}};
}

template <int dim>
JacobianBounds jacobian_bounds(std::span<const Point<dim>> points, double tolerance) {
  const JacobianPolynomial<dim> jacobian(points);
  JacobianBounds bounds = jacobian_bounds(jacobian, tolerance);
  for (Interval* const interval : {&bounds.minimum, &bounds.maximum}) {
    interval->lower = std::ldexp(interval->lower, jacobian.exponent());
    interval->upper = std::ldexp(interval->upper, jacobian.exponent());
  }
  return bounds;
}

#define SMOOTHFEM_INSTANTIATE(DIM)                                                 \
  template bool is_proven_valid(const JacobianPolynomial<DIM>&);                   \
  template bool is_proven_valid(std::span<const Point<DIM>>);                      \
  template JacobianBounds jacobian_bounds(const JacobianPolynomial<DIM>&, double); \
  template JacobianBounds jacobian_bounds(std::span<const Point<DIM>>, double);
SMOOTHFEM_INSTANTIATE(2)
SMOOTHFEM_INSTANTIATE(3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
