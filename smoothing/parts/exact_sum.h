// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "smoothing/parts/mesh_part.h"

namespace smoothfem {

/// An exact sum of floating-point numbers: it does not depend on the order of its terms, and so not
/// on who adds them. It has 32 bits for each integer of the array, over the range of all numbers; a
/// term adds to three of them. Up to 2^31 terms a process. Source: R. M. Neal, Fast exact summation
/// using small and large superaccumulators, arXiv:1505.05571 (2015).
class ExactSum {
 public:
  void add(double term) {
    constexpr int fraction_bits = 52;
    constexpr std::uint64_t one = std::uint64_t{1} << fraction_bits;
    const auto bits = std::bit_cast<std::uint64_t>(term);
    const auto exponent = static_cast<int>(bits >> fraction_bits & 0x7ff);
    if (exponent == 0x7ff) {
      ++chunks_.back();
      return;
    }
    // |term| = mantissa 2^(position - 1074)
    const std::uint64_t mantissa = (bits & (one - 1)) | (exponent > 0 ? one : 0);
    const int position = exponent > 0 ? exponent - 1 : 0;
    const auto first = static_cast<std::size_t>(position / width);
    const int shift = position % width;
    const auto above = static_cast<std::int64_t>(mantissa >> (width - shift));
    const std::int64_t sign = bits >> 63 != 0 ? -1 : 1;
    chunks_[first] += sign * static_cast<std::int64_t>(mantissa << shift & mask);
    chunks_[first + 1] += sign * (above & mask);
    chunks_[first + 2] += sign * (above >> width);
  }
  void add(const ExactSum& other) {
    for (std::size_t i = 0; i < chunks_.size(); ++i) chunks_[i] += other.chunks_[i];
  }

  /// Returns the sum of the terms here, rounded; infinity if a term is not finite.
  double total() const {
    ExactSum all = *this;
    all.carry();
    return all.rounded();
  }
  /// Returns the sum over all ranks. Collective.
  double total(const MeshPart& part) const {
    ExactSum all = *this;
    all.carry();
    part.sum(all.chunks_);
    return all.total();
  }

 private:
  static constexpr int width = 32;
  static constexpr std::int64_t mask = 0xffffffff;
  static constexpr std::size_t n_chunks = 67;

  /// Makes all chunks nonnegative and less than 2^32, except the highest, which has the sign.
  void carry() {
    for (std::size_t i = 0; i + 1 < n_chunks; ++i) {
      chunks_[i + 1] += chunks_[i] >> width;
      chunks_[i] &= mask;
    }
  }
  double rounded() const {
    if (chunks_.back() != 0) return std::numeric_limits<double>::infinity();
    if (chunks_[n_chunks - 1] < 0) {
      ExactSum negative;
      for (std::size_t i = 0; i < n_chunks; ++i) negative.chunks_[i] = -chunks_[i];
      return -negative.total();
    }
    double sum = 0.0;
    for (std::size_t i = n_chunks; i-- > 0;)
      if (chunks_[i] != 0)
        sum += std::ldexp(static_cast<double>(chunks_[i]), width * static_cast<int>(i) - 1074);
    return sum;
  }

  std::array<std::int64_t, n_chunks + 1> chunks_{};  ///< the last one counts infinite terms
};

}  // namespace smoothfem
