// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace smoothfem {

/// SplitMix64 (Steele, Lea and Flood, Fast splittable pseudorandom number generators, OOPSLA 2014).
/// Results are bitwise identical on every machine, which standard distributions do not promise.
class SplitMix64 {
 public:
  explicit SplitMix64(std::uint64_t state) : state_(state) {}

  /// Returns the next number: a Weyl sequence with the golden ratio's step, mixed.
  std::uint64_t next() {
    state_ += golden_step;
    return mixed(state_);
  }

  /// Returns a number that is uniform in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

  /// Returns a number that is uniform in [0, n), n >= 1: the high half of the 128-bit product. The
  /// bias is below n 2^-64.
  std::uint64_t below(std::uint64_t n) {
    __extension__ using Product = unsigned __int128;
    return static_cast<std::uint64_t>(static_cast<Product>(next()) * n >> 64);
  }

 private:
  static constexpr std::uint64_t golden_step = 0x9e3779b97f4a7c15;

  /// Applies Stafford's variant 13 of the MurmurHash3 finalizer, as in the paper.
  static constexpr std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

/// Returns random numbers that depend only on a seed and counters, for example a node and a sweep.
/// The order of use does not matter.
inline SplitMix64 counter_random(std::uint64_t seed, std::uint64_t stream, std::uint64_t item) {
  const std::uint64_t hash = SplitMix64(SplitMix64(seed).next() + stream).next();
  return SplitMix64(SplitMix64(hash + item).next());
}

}  // namespace smoothfem
