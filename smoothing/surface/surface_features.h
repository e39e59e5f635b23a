// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "smoothing/mesh/midside_nodes.h"
#include "smoothing/mesh/node_constraints.h"

namespace smoothfem {

/// A surface in space: facets with three or more nodes, all with the same orientation.
struct SurfaceFacets {
  CompressedRows<NodeIndex> nodes;
  std::vector<int> tags;  ///< labels whose borders are features; empty: none
  std::vector<std::array<NodeIndex, 2>> marked_edges;  ///< edges that are features at any angle
  /// Of each facet, the nodes of its sides and in its middle, as midside_of_facets() returns them;
  /// no rows if all facets are linear.
  CompressedRows<NodeIndex> midside = {};

  /// Returns corners and midside nodes of a facet; nothing if it is linear, or a side of it.
  std::vector<NodeIndex> curved_nodes(std::size_t facet) const {
    std::vector<NodeIndex> row;
    if (midside.size() == 0) return row;
    const auto others = midside[facet];
    if (std::find(others.begin(), others.end(), no_corner) != others.end()) return row;
    for (const auto part : {nodes[facet], others}) row.insert(row.end(), part.begin(), part.end());
    return row;
  }
};

/// Rules for feature edges of a surface, which smoothing has to keep.
struct FeatureParameters {
  /// Largest angle, in (0, 180] degrees. Edges whose facets deviate from flat by more are features.
  /// Nodes where a feature line turns by more are corners.
  double angle_degrees = 40.0;
};

/// A surface divided at its feature edges. These are edges between facets that meet at an angle or
/// have different tags, marked edges, and the surface's boundary: edges with one or more than two
/// facets. Corners are nodes where other than two feature edges meet, or where two make an angle.
struct SurfaceFeatures {
  std::vector<GeometricClassification> classifications;  ///< of each node
  std::vector<std::uint32_t> facet_patches;              ///< smooth part of each facet
  std::vector<std::array<NodeIndex, 2>> feature_edges;   ///< the lower node first, ascending
  std::vector<NodeIndex> edge_middles;    ///< of each feature edge; no_corner: it is straight
  std::vector<std::uint32_t> edge_lines;  ///< line of each feature edge
};

/// Angles of facets of second order are those between their normals in the middle of the common
/// edge, and between the tangents of feature lines at their common node. Midside nodes belong to
/// the line of their edge, or to the smooth part of their facet.
///
/// Throws InputError for an angle out of range, and for two facets that run along their common edge
/// in the same direction. All sides of a facet without area are features.
SurfaceFeatures find_features(const SurfaceFacets& facets, std::span<const Point<3>> coordinates,
                              const FeatureParameters& parameters);

}  // namespace smoothfem
