// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "smoothing/mesh/node_constraints.h"

namespace smoothfem {

/// A surface in space: facets with three or more nodes, all running around the same side of it.
struct SurfaceFacets {
  CompressedRows<NodeIndex> nodes;
  std::vector<int> tags;  ///< labels whose borders are features; empty: none
  std::vector<std::array<NodeIndex, 2>> marked_edges;  ///< features whatever their angle
};

/// When an edge of a surface is a feature that smoothing has to keep.
struct FeatureParameters {
  /// Edges whose facets meet at an angle more than this off flat are features, and nodes where a
  /// line of features turns by more are corners. In (0, 180] degrees.
  double angle_degrees = 40.0;
};

/// A surface taken apart at its features: edges between facets that meet at an angle, have
/// different tags, are marked, or where other than two facets meet (the surface's boundary).
/// Corners are nodes where other than two feature edges meet or where two make an angle.
struct SurfaceFeatures {
  std::vector<GeometricClassification> classifications;  ///< of each node
  std::vector<std::uint32_t> facet_patches;              ///< the smooth part of each facet
  std::vector<std::array<NodeIndex, 2>> feature_edges;   ///< the lower node first, ascending
  std::vector<std::uint32_t> edge_lines;                 ///< the line of each feature edge
};

/// Throws InputError for an angle out of range, and for two facets that run along their common edge
/// in the same direction. All sides of a facet without area are features.
SurfaceFeatures find_features(const SurfaceFacets& facets, std::span<const Point<3>> coordinates,
                              const FeatureParameters& parameters);

}  // namespace smoothfem
