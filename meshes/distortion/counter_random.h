// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace smoothfem {

/// SplitMix64 (Steele, Lea and Flood, Fast splittable pseudorandom number generators, OOPSLA 2014).
/// Gives the same bits on every machine, which standard distributions do not promise.
class SplitMix64 {
 public:
  explicit SplitMix64(std::uint64_t state) : state_(state) {}

  /// The next number: a Weyl sequence with the golden ratio's step, mixed.
  std::uint64_t next() {
    state_ += golden_step;
    return mixed(state_);
  }

  /// Uniform in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

  /// Uniform in [0, n), n >= 1, by the high half of the 128-bit product; the bias is below n 2^-64.
  std::uint64_t below(std::uint64_t n) {
    __extension__ using Product = unsigned __int128;
    return static_cast<std::uint64_t>(static_cast<Product>(next()) * n >> 64);
  }

 private:
  static constexpr std::uint64_t golden_step = 0x9e3779b97f4a7c15;

  /// Stafford's variant 13 of the MurmurHash3 finalizer, as in the paper.
  static constexpr std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

/// Random numbers that depend on nothing but what they are for, for example a node and a sweep: the
/// same seed and counters give the same ones in every order of use.
inline SplitMix64 counter_random(std::uint64_t seed, std::uint64_t stream, std::uint64_t item) {
  const std::uint64_t hash = SplitMix64(SplitMix64(seed).next() + stream).next();
  return SplitMix64(SplitMix64(hash + item).next());
}

}  // namespace smoothfem
