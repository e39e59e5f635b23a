// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "smoothing/parts/mesh_part.h"

namespace smoothfem {

/// A sum that does not depend on the order of its terms, and so not on who adds them. Each term is
/// rounded down to a multiple of 2^(exponent - 60), which two integers hold. Sums of up to 2^32
/// terms are exact. Source of the idea: Demmel, Nguyen, Fast reproducible floating-point summation,
/// ARITH 2013.
class OrderFreeSum {
 public:
  /// Terms are from 0 to 2^exponent.
  explicit OrderFreeSum(int exponent = 0) : exponent_(exponent) {}

  void add(double term) {
    const double scaled = std::ldexp(term, 30 - exponent_), high = std::floor(scaled);
    parts_[0] += static_cast<std::int64_t>(high);
    parts_[1] += static_cast<std::int64_t>(std::ldexp(scaled - high, 30));
  }
  void add(const OrderFreeSum& other) {
    parts_[0] += other.parts_[0];
    parts_[1] += other.parts_[1];
  }

  /// Returns the sum over all ranks. Collective.
  double total(const MeshPart& part) const {
    auto parts = parts_;
    part.sum(parts);
    return std::ldexp(static_cast<double>(parts[0]), exponent_ - 30) +
           std::ldexp(static_cast<double>(parts[1]), exponent_ - 60);
  }

 private:
  int exponent_;
  std::array<std::int64_t, 2> parts_{};
};

}  // namespace smoothfem
