// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>

#include "smoothing/mesh/volume_elements.h"
#include "smoothing/simd/vectors.h"

namespace smoothfem {

/// Edge of the volume element with n nodes between two of its nodes, and whether it runs the other
/// way round. Fails at compile time if there is no such edge.
struct DirectedEdge {
  std::size_t index;
  bool reversed;
};
template <std::size_t n>
consteval DirectedEdge edge_between(LocalIndex from, LocalIndex to) {
  const auto& edges = VolumeElement<n>::edges;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges[e][0] == from && edges[e][1] == to) return {e, false};
    if (edges[e][0] == to && edges[e][1] == from) return {e, true};
  }
  throw "no edge between these nodes";
}

/// The edge vectors of a volume cell and their squared lengths. Computed once, as the quality and
/// the size of a cell both need them.
template <class Real, std::size_t n>
struct CellEdges {
  static constexpr std::size_t n_edges = VolumeElement<n>::edges.size();
  std::array<Vector3<Real>, n_edges> vectors;
  std::array<Real, n_edges> squared_lengths;

  explicit CellEdges(std::span<const Vector3<Real>, n> nodes) {
    unrolled<n_edges>([&](auto e) {
      constexpr LocalEdge edge = VolumeElement<n>::edges[e];
      vectors[e] = nodes[edge[1]] - nodes[edge[0]];
      squared_lengths[e] = squared_length(vectors[e]);
    });
  }
};

}  // namespace smoothfem
