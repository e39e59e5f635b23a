// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

/// Geometry formulas are written once, as templates over the number type Real: double for one cell,
/// Lanes for several cells of one type at a time. Results for each cell are bitwise identical: both
/// have the same operations in the same order, none of them contracted. The compiler and its flags
/// choose the registers of the lanes.

namespace smoothfem {

constexpr std::size_t n_lanes = 4;
/// For local variables only: code for wider registers expects a stronger alignment than that of
/// std::vector<Lanes>. Store arrays as double (load_lanes).
using Lanes = double __attribute__((vector_size(n_lanes * sizeof(double))));
using LaneBits = std::uint64_t __attribute__((vector_size(n_lanes * sizeof(std::uint64_t))));
/// Result of comparing Lanes.
using LaneMask = std::int64_t __attribute__((vector_size(n_lanes * sizeof(std::int64_t))));
/// Lanes of single precision, as many as in Lanes.
using FloatLanes = float __attribute__((vector_size(n_lanes * sizeof(float))));

/// Calls visit(std::integral_constant<std::size_t, i>{}) for i = 0 .. n-1. The loop is always
/// unrolled, and i can select from constant tables at compile time.
template <std::size_t n, class Visit>
inline void unrolled(const Visit& visit) {
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (visit(std::integral_constant<std::size_t, i>{}), ...);
  }
  (std::make_index_sequence<n>{});
}

/// Loads n_lanes numbers of an array of double or float, at any address. (With std::memcpy GCC goes
/// through the stack.)
template <class Number>
struct ArrayLanes;
template <>
struct ArrayLanes<double> {
  using Values = Lanes;
  using Unaligned  // clang forgets the alignment if the attributes follow the type
      __attribute__((vector_size(sizeof(Lanes)), aligned(sizeof(double)), may_alias)) = double;
};
template <>
struct ArrayLanes<float> {
  using Values = FloatLanes;
  using Unaligned
      __attribute__((vector_size(sizeof(FloatLanes)), aligned(sizeof(float)), may_alias)) = float;
};

template <class Number>
inline typename ArrayLanes<Number>::Values load_lanes(const Number* numbers) {
  return *reinterpret_cast<const typename ArrayLanes<Number>::Unaligned*>(numbers);
}
template <class Number>
inline void store_lanes(typename ArrayLanes<Number>::Values lanes, Number* numbers) {
  *reinterpret_cast<typename ArrayLanes<Number>::Unaligned*>(numbers) = lanes;
}

inline double square_root(double value) {
  return std::sqrt(value);
}
inline Lanes square_root(Lanes value) {
  return Lanes{std::sqrt(value[0]), std::sqrt(value[1]), std::sqrt(value[2]), std::sqrt(value[3])};
}

/// Returns the number in one lane; a double is its own only lane.
inline double lane(Lanes lanes, std::size_t l) {
  return lanes[l];
}
inline double lane(double number, std::size_t) {
  return number;
}
inline void set_lane(Lanes& lanes, std::size_t l, double value) {
  lanes[l] = value;
}
inline void set_lane(double& number, std::size_t, double value) {
  number = value;
}

/// Returns the sum of the first `count` lanes, in their order.
inline double sum_of_lanes(double value, std::size_t) {
  return value;
}
inline double sum_of_lanes(Lanes value, std::size_t count) {
  double sum = 0.0;
  for (std::size_t l = 0; l < count; ++l) sum += value[l];
  return sum;
}

/// Transposes four vectors of lanes to one vector of four entries for each lane.
template <class AnyLanes>
inline std::array<AnyLanes, n_lanes> transposed(AnyLanes a, AnyLanes b, AnyLanes c, AnyLanes d) {
  const AnyLanes even_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const AnyLanes odd_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const AnyLanes even_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const AnyLanes odd_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return {__builtin_shufflevector(even_ab, even_cd, 0, 1, 4, 5),
          __builtin_shufflevector(odd_ab, odd_cd, 0, 1, 4, 5),
          __builtin_shufflevector(even_ab, even_cd, 2, 3, 6, 7),
          __builtin_shufflevector(odd_ab, odd_cd, 2, 3, 6, 7)};
}

}  // namespace smoothfem
