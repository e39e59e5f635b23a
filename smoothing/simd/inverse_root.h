// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>

#include "smoothing/simd/lanes.h"

namespace smoothfem {

/// Inverse p-th root x^(-1/p), p = 2, 3 or 4, for positive normal numbers; relative error below
/// 4e-16. Uses additions and multiplications only, so that results are bitwise identical on every
/// machine. The result for zero and negative numbers is undefined.
///
/// The bits of a number, read as an integer, are nearly linear in its logarithm. Dividing that
/// integer by -p gives a start with an error of four percent. Each of the two steps raises the
/// error to its fourth power. With e = 1 - x y^p, x^(-1/p) = y (1 - e)^(-1/p); the series stops
/// after e^3.
template <int p, class Real>
inline Real inverse_root(Real x) {
  static_assert(p >= 2 && p <= 4);
  // The upper 52 of the 63 bits after the sign, as a number: they become the mantissa of 2^52.
  constexpr double two_52 = 0x1p52;
  constexpr std::uint64_t bits_of_two_52 = std::bit_cast<std::uint64_t>(two_52);
  constexpr double one = static_cast<double>(std::bit_cast<std::uint64_t>(1.0) >> 12);
  constexpr double middle = 0.0450466 * 0x1p40;  // halves the largest error of the linear logarithm
  constexpr double offset = (1.0 + 1.0 / p) * (one - middle);
  Real y;
  if constexpr (std::is_same_v<Real, double>) {
    const auto mantissa = (std::bit_cast<std::uint64_t>(x) >> 12) | bits_of_two_52;
    const double logarithm = std::bit_cast<double>(mantissa) - two_52;
    const double start = two_52 + (offset - (1.0 / p) * logarithm);
    y = std::bit_cast<double>(std::bit_cast<std::uint64_t>(start) << 12);
  } else {
    const LaneBits mantissa = (reinterpret_cast<LaneBits>(x) >> 12) | bits_of_two_52;
    const Real logarithm = reinterpret_cast<Real>(mantissa) - two_52;
    const Real start = two_52 + (offset - (1.0 / p) * logarithm);
    y = reinterpret_cast<Real>(reinterpret_cast<LaneBits>(start) << 12);
  }
  constexpr double c1 = 1.0 / p, c2 = c1 * (c1 + 1.0) / 2.0, c3 = c2 * (c1 + 2.0) / 3.0;
  unrolled<2>([&](auto) {
    const Real square = y * y;
    const Real power = p == 2 ? square : p == 3 ? square * y : square * square;
    const Real e = 1.0 - x * power;
    y += (y * e) * (c1 + e * (c2 + c3 * e));
  });
  return y;
}

}  // namespace smoothfem
