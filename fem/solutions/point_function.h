// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <span>
#include <type_traits>
#include <utility>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// A function of the position. Some are faster at many points at once; the values are the same,
/// bitwise.
template <int dim, class Value>
class PointFunction {
 public:
  using At = std::function<Value(const Point<dim>&)>;
  using AtAll = std::function<void(std::span<const Point<dim>>, std::span<Value>)>;

  PointFunction() = default;
  /// at_all: writes the values at points; empty: point by point.
  PointFunction(At at, AtAll at_all) : at_(std::move(at)), at_all_(std::move(at_all)) {}
  template <class F,
            std::enable_if_t<std::is_invocable_r_v<Value, const F&, const Point<dim>&>, int> = 0>
  PointFunction(F at) : at_(std::move(at)) {}  // NOLINT: as std::function

  Value operator()(const Point<dim>& p) const { return at_(p); }

  /// values: one for each point.
  void at(std::span<const Point<dim>> points, std::span<Value> values) const {
    if (at_all_) return at_all_(points, values);
    for (std::size_t k = 0; k < points.size(); ++k) values[k] = at_(points[k]);
  }

  explicit operator bool() const { return static_cast<bool>(at_); }

 private:
  At at_;
  AtAll at_all_;
};

/// The number of points that loops over quadrature points take at once.
inline constexpr std::size_t n_points_at_once = 16;

}  // namespace smoothfem
