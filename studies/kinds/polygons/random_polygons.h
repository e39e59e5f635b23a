// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <numbers>

#include "meshes/distortion/counter_random.h"
#include "smoothing/polygons/polygon.h"

namespace smoothfem {

constexpr double pi = std::numbers::pi;

/// Returns a uniform random number in (from, to).
inline double uniform(SplitMix64& random, double from, double to) {
  return from + (to - from) * random.uniform();
}

/// Returns a polygon whose nodes are uniform in the square from -1 - i to 1 + i.
inline Polygon random_polygon(std::size_t n, SplitMix64& random) {
  Polygon polygon;
  for (std::size_t k = 0; k < n; ++k) {
    const double x = uniform(random, -1.0, 1.0), y = uniform(random, -1.0, 1.0);
    polygon.emplace_back(x, y);
  }
  return polygon;
}

/// Returns the polygon that all pictures of n-gons of a study start from.
inline Polygon picture_polygon(std::size_t n, std::uint64_t seed) {
  SplitMix64 random = counter_random(seed, 0, n);
  return random_polygon(n, random);
}

/// Returns point i of n grid points, in the middles of equal parts of (0, length).
inline double grid_point(std::size_t i, std::size_t n, double length) {
  return length * (static_cast<double>(i) + 0.5) / static_cast<double>(n);
}

}  // namespace smoothfem
