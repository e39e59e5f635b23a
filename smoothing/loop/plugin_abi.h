// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Memory layout of the types that a plugin shares with the program: one for each kind of things
/// that plugins register. Every library with such a thing contains it. load_plugin looks for it in
/// the file before any of its code runs.
struct PluginAbi {
  std::array<char, 24> mark;
  std::array<std::uint32_t, 14> numbers;
  bool operator==(const PluginAbi&) const = default;
};

/// Increase it when functions that plugins call or provide change but no type's size does.
inline constexpr std::uint32_t plugin_interface = 2;

/// Returns the layout of a kind. mark: 23 characters, which no other kind has.
constexpr PluginAbi abi_with(const char (&mark)[24], std::array<std::uint32_t, 5> own) {
  PluginAbi abi{{},
                {plugin_interface, __GXX_ABI_VERSION, _GLIBCXX_USE_CXX11_ABI, EIGEN_WORLD_VERSION,
                 EIGEN_MAJOR_VERSION, EIGEN_MAX_ALIGN_BYTES, alignof(Point<2>), sizeof(Mesh<3>),
                 sizeof(Topology), own[0], own[1], own[2], own[3], own[4]}};
  std::copy(std::begin(mark), std::end(mark), abi.mark.begin());
  return abi;
}

}  // namespace smoothfem
