// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <type_traits>

namespace smoothfem {

/// Type of the numbers of an array in a VTK file.
enum class VtkNumber { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

struct VtkNumberName {
  std::string_view name;
  VtkNumber type;
};

/// Returns the type of a name; nothing if there is no such type.
template <std::size_t n>
std::optional<VtkNumber> vtk_number(const std::array<VtkNumberName, n>& names,
                                    std::string_view name) {
  const auto* found = std::find_if(names.begin(), names.end(),
                                   [&](const VtkNumberName& entry) { return entry.name == name; });
  if (found == names.end()) return {};
  return found->type;
}

/// Calls `visit.operator()<T>()` with the C++ type.
template <class Visit>
decltype(auto) with_vtk_number(VtkNumber type, const Visit& visit) {
  switch (type) {
    case VtkNumber::int8:
      return visit.template operator()<std::int8_t>();
    case VtkNumber::uint8:
      return visit.template operator()<std::uint8_t>();
    case VtkNumber::int16:
      return visit.template operator()<std::int16_t>();
    case VtkNumber::uint16:
      return visit.template operator()<std::uint16_t>();
    case VtkNumber::int32:
      return visit.template operator()<std::int32_t>();
    case VtkNumber::uint32:
      return visit.template operator()<std::uint32_t>();
    case VtkNumber::int64:
      return visit.template operator()<std::int64_t>();
    case VtkNumber::uint64:
      return visit.template operator()<std::uint64_t>();
    case VtkNumber::float32:
      return visit.template operator()<float>();
    default:
      return visit.template operator()<double>();
  }
}

inline std::size_t size_of(VtkNumber type) {
  return with_vtk_number(type, []<class T>() { return sizeof(T); });
}

inline bool is_integer(VtkNumber type) {
  return with_vtk_number(type, []<class T>() { return std::is_integral_v<T>; });
}

/// Changes the byte order. Bits: an unsigned integer.
template <class Bits>
Bits with_bytes_swapped(Bits bits) {
  if constexpr (sizeof(Bits) == 2) bits = __builtin_bswap16(bits);
  if constexpr (sizeof(Bits) == 4) bits = __builtin_bswap32(bits);
  if constexpr (sizeof(Bits) == 8) bits = __builtin_bswap64(bits);
  return bits;
}

/// Calls use(number) for n numbers in memory, each as Value: double, or std::int64_t for types of
/// integers (larger numbers become negative).
template <class Value, class Use>
void for_each_vtk_number(VtkNumber type, bool is_swapped, const char* bytes, std::size_t n,
                         const Use& use) {
  with_vtk_number(type, [&]<class T>() {
    if constexpr (std::is_floating_point_v<Value> || std::is_integral_v<T>) {
      using Bits = std::conditional_t<
          sizeof(T) == 1, std::uint8_t,
          std::conditional_t<sizeof(T) == 2, std::uint16_t,
                             std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>>;
      for (std::size_t i = 0; i < n; ++i) {
        Bits bits;
        std::memcpy(&bits, bytes + i * sizeof bits, sizeof bits);
        if (is_swapped) bits = with_bytes_swapped(bits);
        T number;
        std::memcpy(&number, &bits, sizeof number);
        use(static_cast<Value>(number));
      }
    }
  });
}

}  // namespace smoothfem
