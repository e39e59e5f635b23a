// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "smoothing/loop/parameter.h"
#include "smoothing/loop/smoother.h"

namespace smoothfem {

/// Memory layout of the types that a plugin shares with the program. Every library with a method
/// contains it. load_plugin looks for it in the file before any of its code runs.
struct PluginAbi {
  std::array<char, 24> mark;
  std::array<std::uint32_t, 14> numbers;
  bool operator==(const PluginAbi&) const = default;
};

/// Increase it when functions that plugins call or provide change but no type's size does.
inline constexpr std::uint32_t plugin_interface = 1;

[[gnu::used]] inline constexpr PluginAbi plugin_abi{
    {"smoothfem plugin types:"},
    {plugin_interface, __GXX_ABI_VERSION, _GLIBCXX_USE_CXX11_ABI, EIGEN_WORLD_VERSION,
     EIGEN_MAJOR_VERSION, EIGEN_MAX_ALIGN_BYTES, alignof(Point<2>), sizeof(Mesh<3>),
     sizeof(Topology), sizeof(SmoothingState<3>), sizeof(StepReport), sizeof(StoppingRule),
     sizeof(Parameter), sizeof(SmootherTraits)}};

}  // namespace smoothfem
