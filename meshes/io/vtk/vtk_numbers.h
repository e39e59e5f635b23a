// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <type_traits>

#include "smoothing/mesh/number_type.h"

namespace smoothfem {

using VtkNumber = NumberType;

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

/// Names of types in .vtu files.
inline constexpr std::array vtu_type_names{
    VtkNumberName{"Int8", VtkNumber::int8},       VtkNumberName{"UInt8", VtkNumber::uint8},
    VtkNumberName{"Int16", VtkNumber::int16},     VtkNumberName{"UInt16", VtkNumber::uint16},
    VtkNumberName{"Int32", VtkNumber::int32},     VtkNumberName{"UInt32", VtkNumber::uint32},
    VtkNumberName{"Int64", VtkNumber::int64},     VtkNumberName{"UInt64", VtkNumber::uint64},
    VtkNumberName{"Float32", VtkNumber::float32}, VtkNumberName{"Float64", VtkNumber::float64}};

/// A number that may also be infinite, or none: of data, unlike a coordinate.
struct AnyNumber {
  double value;
  template <class T>
  explicit AnyNumber(T number) : value(static_cast<double>(number)) {}
};

/// An integer of data: of 64 bits, without a sign kept as its bits; fractions in text are cut off.
struct AnyInteger {
  std::int64_t value;
  template <class T>
  explicit AnyInteger(T number) : value(static_cast<std::int64_t>(number)) {}
};

/// Returns a word of text as a number; nothing if it is not one.
inline std::optional<AnyNumber> any_number(std::string_view word) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc::invalid_argument || end != word.data() + word.size()) return {};
  return AnyNumber(value);
}

inline std::optional<AnyInteger> any_integer(std::string_view word) {
  const auto parsed = [&]<class T>(T value) -> std::optional<AnyInteger> {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) return {};
    return AnyInteger(value);
  };
  if (const auto value = parsed(std::int64_t{0})) return value;
  if (const auto value = parsed(std::uint64_t{0})) return value;
  const auto number = any_number(word);
  if (!number || !(std::abs(number->value) < 0x1p63)) return {};
  return AnyInteger(number->value);
}

/// Changes the byte order. Bits: an unsigned integer.
template <class Bits>
Bits with_bytes_swapped(Bits bits) {
  if constexpr (sizeof(Bits) == 2) bits = __builtin_bswap16(bits);
  if constexpr (sizeof(Bits) == 4) bits = __builtin_bswap32(bits);
  if constexpr (sizeof(Bits) == 8) bits = __builtin_bswap64(bits);
  return bits;
}

/// Calls use(number) for n numbers in memory, each as Value: double, AnyNumber, or std::int64_t or
/// AnyInteger for types of integers (larger numbers become negative).
template <class Value, class Use>
void for_each_vtk_number(VtkNumber type, bool is_swapped, const char* bytes, std::size_t n,
                         const Use& use) {
  with_number_type(type, [&]<class T>() {
    if constexpr (std::is_integral_v<T> ||
                  !(std::is_integral_v<Value> || std::is_same_v<Value, AnyInteger>)) {
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
