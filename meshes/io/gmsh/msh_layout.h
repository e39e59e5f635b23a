// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace smoothfem {

/// Nodes of one entity: n tags of 64 bits, then n times n_numbers coordinates.
struct MshNodeBlock {
  std::uint64_t n = 0, tags_at = 0, points_at = 0;  ///< positions in the file
  int n_numbers = 3;                                ///< of a node: 3, or more with parameters
};

/// Elements of one entity and type: n times the tag and the nodes' tags, of 64 bits each.
struct MshElementBlock {
  std::uint64_t n, at;
  int dimension;
  bool has_group;  ///< whether the entity is in a physical group
  int material;    ///< of its groups (MaterialNumbers)
  std::uint32_t n_nodes;
};

/// Where a binary .msh file of version 4.1 has its nodes and elements, so that several processes
/// can each read a part of it.
struct MshLayout {
  std::vector<MshNodeBlock> nodes{};
  std::vector<MshElementBlock> elements{};
  std::uint64_t last_node = 0, last_element = 0;  ///< the largest tags
  std::string obstacle{};  ///< why the file cannot be read in parts; empty if it can
};

/// Finds the blocks; reads their headers and the model's entities only. Obstacles are other
/// versions and encodings, elements of second order, periodic nodes, tags with large
/// gaps or above 32 bits, and data that say which nodes must stay. Damaged and missing
/// files have an obstacle, too: read_mesh() names the fault.
MshLayout msh_layout(const std::filesystem::path& path);

}  // namespace smoothfem
