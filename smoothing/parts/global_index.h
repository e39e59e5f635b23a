// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <compare>
#include <cstdint>

namespace smoothfem {

/// Number of a node or cell in the whole mesh.
using GlobalIndex = std::uint32_t;

/// A cell of the whole mesh with a number by which cells are compared.
struct KeyedCell {
  double key;
  GlobalIndex cell;

  auto operator<=>(const KeyedCell&) const = default;
};

}  // namespace smoothfem
