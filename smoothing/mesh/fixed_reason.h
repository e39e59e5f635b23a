// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace smoothfem {

/// Why smoothing must not move a node.
enum class FixedReason : std::uint16_t {
  boundary = 1 << 0,   ///< on the boundary of the mesh
  marked = 1 << 1,     ///< marked as fixed by the file, an option or the caller
  interface = 1 << 2,  ///< between cells of different tags, or on a labelled inner facet
  required = 1 << 3,   ///< on an element that the file requires
  hanging = 1 << 4,    ///< inside an edge or a face of another cell, or on a seam of such nodes
  layer = 1 << 5,      ///< in a stack of thin cells that is kept
  periodic = 1 << 6,   ///< has a periodic partner
  corner = 1 << 7,     ///< corner of a surface
  unused = 1 << 8,     ///< no cell uses it
  midside = 1 << 9     ///< follows the corners of its cell (midside_nodes.h)
};

/// Any number of reasons, one bit each. 0: the node is free.
using FixedReasons = std::uint16_t;

constexpr FixedReasons bit(FixedReason reason) {
  return static_cast<FixedReasons>(reason);
}
constexpr bool has(FixedReasons reasons, FixedReason reason) {
  return (reasons & bit(reason)) != 0;
}

struct NamedFixedReason {
  FixedReason reason;
  std::string_view name;  ///< for lists and JSON
};
/// All but those of midside nodes, which do not stay but follow.
inline constexpr std::array fixed_reasons{NamedFixedReason{FixedReason::boundary, "boundary"},
                                          NamedFixedReason{FixedReason::marked, "marked"},
                                          NamedFixedReason{FixedReason::interface, "interface"},
                                          NamedFixedReason{FixedReason::required, "required"},
                                          NamedFixedReason{FixedReason::hanging, "hanging"},
                                          NamedFixedReason{FixedReason::layer, "layer"},
                                          NamedFixedReason{FixedReason::periodic, "periodic"},
                                          NamedFixedReason{FixedReason::corner, "corner"},
                                          NamedFixedReason{FixedReason::unused, "unused"}};

}  // namespace smoothfem
