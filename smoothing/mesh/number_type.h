// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace smoothfem {

/// Type of the numbers of an array in a mesh file.
enum class NumberType {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};

/// Calls `visit.operator()<T>()` with the C++ type.
template <class Visit>
decltype(auto) with_number_type(NumberType type, const Visit& visit) {
  switch (type) {
    case NumberType::int8:
      return visit.template operator()<std::int8_t>();
    case NumberType::uint8:
      return visit.template operator()<std::uint8_t>();
    case NumberType::int16:
      return visit.template operator()<std::int16_t>();
    case NumberType::uint16:
      return visit.template operator()<std::uint16_t>();
    case NumberType::int32:
      return visit.template operator()<std::int32_t>();
    case NumberType::uint32:
      return visit.template operator()<std::uint32_t>();
    case NumberType::int64:
      return visit.template operator()<std::int64_t>();
    case NumberType::uint64:
      return visit.template operator()<std::uint64_t>();
    case NumberType::float32:
      return visit.template operator()<float>();
    default:
      return visit.template operator()<double>();
  }
}

inline std::size_t size_of(NumberType type) {
  return with_number_type(type, []<class T>() { return sizeof(T); });
}

inline bool is_integer(NumberType type) {
  return with_number_type(type, []<class T>() { return std::is_integral_v<T>; });
}

}  // namespace smoothfem
