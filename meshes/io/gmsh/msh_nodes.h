// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "meshes/io/gmsh/msh_groups.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Returns the positions of some tags from the smallest to the largest; equal tags stay in their
/// order.
inline std::vector<std::size_t> ascending_order(const std::vector<std::size_t>& tags) {
  std::vector<std::size_t> order(tags.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return tags[a] < tags[b]; });
  return order;
}

template <class Value>
std::vector<Value> in_order(const std::vector<Value>& values,
                            const std::vector<std::size_t>& order) {
  std::vector<Value> result;
  result.reserve(order.size());
  for (const std::size_t i : order) result.push_back(values[i]);
  return result;
}

/// The layouts of version 4.
enum class MshVersion4 { v4_0, v4_1 };

/// Reads the end of the first record of $Nodes and $Elements: in version 4.1 the smallest and the
/// largest tag, which are not used.
template <class Input>
void msh_end_of_totals(Input& in, MshVersion4 version) {
  if (version == MshVersion4::v4_1)
    for (const char* what : {"the smallest tag", "the largest tag"})
      if (in.has_value()) in.count(what);
  in.end();
}

/// Reads the dimension and the number of a block's entity, the beginning of its first record.
/// Version 4.0 has the opposite order.
template <class Input>
std::pair<int, int> msh_entity_of_block(Input& in, MshVersion4 version) {
  const int first = in.integer("block"), second = in.integer("block");
  if (version == MshVersion4::v4_0) return {second, first};
  return {first, second};
}

template <class Input>
void msh_require_total(const Input& in, const char* what, std::uint64_t n_found,
                       std::uint64_t n_announced) {
  if (n_found != n_announced)
    in.fail("the section announces " + std::to_string(n_announced) + " " + what + " but has " +
            std::to_string(n_found));
}

/// The section $Nodes of a .msh file. Input: one of msh_input.h.
class MshNodes {
 public:
  std::vector<std::size_t> tags;  ///< ascending after reading
  std::vector<Point<3>> coordinates;
  std::vector<std::array<int, 2>> entities;  ///< dimension and number, of version 4
  bool has_parameters = false;               ///< the file has parametric coordinates

  /// Reads version 2: a record for each node.
  template <class Input>
  void read_2(Input& in) {
    const std::uint64_t n_nodes = msh_count_in_text(in, "the number of nodes");
    for (std::uint64_t i = 0; i < n_nodes; ++i) {
      in.begin("node", i, n_nodes);
      add_tag(in);
      add_point(in);
      in.end();
    }
    sort(in);
  }

  /// Reads version 4.0: blocks of nodes with tag and coordinates.
  template <class Input>
  void read_4_0(Input& in) {
    read_blocks(in, MshVersion4::v4_0, [&](std::uint64_t n, int n_parameters) {
      for (std::uint64_t i = 0; i < n; ++i) {
        in.begin("node", i, n);
        add_tag(in);
        add_point(in, n_parameters);
        in.end();
      }
    });
  }

  /// Reads version 4.1: blocks of tags, followed by their coordinates.
  template <class Input>
  void read_4_1(Input& in) {
    read_blocks(in, MshVersion4::v4_1, [&](std::uint64_t n, int n_parameters) {
      for (std::uint64_t i = 0; i < n; ++i) {
        in.begin("the tag of node", i, n);
        add_tag(in);
        in.end();
      }
      for (std::uint64_t i = 0; i < n; ++i) {
        in.begin("the coordinates of node", i, n);
        add_point(in, n_parameters);
        in.end();
      }
    });
  }

  /// Returns the node of a tag, or nothing if there is no such node.
  std::optional<NodeIndex> index_of(std::uint64_t tag) const {
    const std::uint64_t guess = tags.empty() ? 0 : tag - tags.front();  // there are mostly no gaps
    if (guess < tags.size() && tags[guess] == tag) return static_cast<NodeIndex>(guess);
    const auto found = std::lower_bound(tags.begin(), tags.end(), tag);
    if (found == tags.end() || *found != tag) return {};
    return static_cast<NodeIndex>(found - tags.begin());
  }

 private:
  template <class Input>
  void add_tag(Input& in) {
    positions_.push_back(in.position());
    tags.push_back(in.tag("the node's tag"));
  }

  template <class Input>
  void add_point(Input& in, int n_parameters = 0) {
    Point<3>& point = coordinates.emplace_back();
    point.x() = in.coordinate("the node's x coordinate");
    point.y() = in.coordinate("the node's y coordinate");
    point.z() = in.coordinate("the node's z coordinate");
    for (int k = 0; k < n_parameters; ++k) in.skip_number("a parametric coordinate");
  }

  /// Reads blocks. read_nodes(n, n_parameters) reads the nodes of a block, with so many parametric
  /// coordinates each.
  template <class Input>
  void read_blocks(Input& in, MshVersion4 version, const auto& read_nodes) {
    in.begin("the numbers of nodes");
    const std::uint64_t n_blocks = in.count("the number of node blocks");
    const std::uint64_t n_nodes = in.count("the number of nodes");
    msh_end_of_totals(in, version);
    for (std::uint64_t b = 0; b < n_blocks; ++b) {
      in.begin("node block", b, n_blocks);
      const auto [dimension, entity] = msh_entity_of_block(in, version);
      if (dimension < 0 || dimension > 3)
        in.fail("the entity's dimension is " + std::to_string(dimension) +
                ", but must be from 0 to 3");
      const int n_parameters = in.integer("block") == 0 ? 0 : dimension;
      const std::uint64_t n = in.count("the number of nodes in the block");
      in.require_bytes(n, sizeof(std::uint64_t) + 3 * sizeof(double));
      has_parameters = has_parameters || (n_parameters > 0 && n > 0);
      read_nodes(n, n_parameters);
      entities.resize(tags.size(), {dimension, entity});
    }
    msh_require_total(in, "nodes", tags.size(), n_nodes);
    sort(in);
  }

  /// Sorts the nodes by their tags, so that the order does not depend on the model's entities.
  template <class Input>
  void sort(Input& in) {
    const auto order = ascending_order(tags);
    for (std::size_t i = 1; i < order.size(); ++i)
      if (tags[order[i]] == tags[order[i - 1]])
        in.fail_at(positions_[order[i]],
                   "the node tag " + std::to_string(tags[order[i]]) + " appears twice");
    if (!std::is_sorted(tags.begin(), tags.end())) {
      coordinates = in_order(coordinates, order);
      tags = in_order(tags, order);
      if (!entities.empty()) entities = in_order(entities, order);
    }
    positions_ = {};
  }

  std::vector<std::size_t> positions_;  ///< positions of the tags in the file during reading
};

}  // namespace smoothfem
