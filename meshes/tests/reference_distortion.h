// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "meshes/tests/mesh_tests.h"

namespace smoothfem {

/// Second implementation of the generator, from the paper's description. The state grows by the odd
/// number next to 2^64 divided by the golden ratio. A number is the state, mixed by two
/// multiplications.
inline std::uint64_t next_number(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15;
  std::uint64_t z = state;
  z ^= z >> 30;
  z *= 0xbf58476d1ce4e5b9;
  z ^= z >> 27;
  z *= 0x94d049bb133111eb;
  return z ^ z >> 31;
}
inline std::uint64_t first_number(std::uint64_t state) {
  return next_number(state);
}

/// A random point of the unit disc; the last coordinate comes first.
inline Point<2> point_of_disc(std::uint64_t& state) {
  const auto coordinate = [&] {
    return 2.0 * std::ldexp(static_cast<double>(next_number(state) >> 11), -53) - 1.0;
  };
  for (;;) {
    const double v = coordinate();
    const double u = coordinate();
    if (u * u + v * v <= 1.0) return {u, v};
  }
}

/// Calls visit(node, mean length of its edges, state of the generator) for the free nodes one after
/// the other, sweep after sweep.
inline void for_each_visit(const PlanarMesh& mesh, std::uint64_t seed, int n_sweeps,
                           const auto& visit) {
  const Topology& topology = mesh.topology();
  const std::vector<Point<2>> x = mesh.copied_coordinates();
  for (int sweep = 0; sweep < n_sweeps; ++sweep)
    for (const NodeIndex node : topology.free_nodes()) {
      double mean_length = 0.0;
      for (const NodeIndex other : topology.node_neighbours(node))
        mean_length += std::sqrt((x[other] - x[node]).squaredNorm());
      mean_length /= static_cast<double>(topology.node_neighbours(node).size());
      visit(node, mean_length,
            first_number(first_number(first_number(seed) + node) +
                         static_cast<std::uint64_t>(sweep)));
    }
}

/// Second implementation of the distortion of triangles, from its documentation and with other
/// formulas: nodes one after the other, with numbers from the generator above.
inline std::vector<Point<2>> reference_distortion(const PlanarMesh& mesh, double radius,
                                                  std::uint64_t seed, int n_candidates,
                                                  int n_sweeps) {
  const Topology& topology = mesh.topology();
  const std::vector<Point<2>> original = mesh.copied_coordinates();
  std::vector<Point<2>> x = original;
  // For a triangle, 2 sqrt(3) times twice its area over the sum of its squared sides. Constants are
  // left out, as only the order matters. At most 0 if one is invalid.
  const auto quality_around = [&](NodeIndex node) {
    double sum = 0.0;
    for (const CellIndex cell : topology.node_cells(node)) {
      const auto t = topology.cell_nodes(cell);
      const Point<2> u = x[t[1]] - x[t[0]], v = x[t[2]] - x[t[0]], w = x[t[2]] - x[t[1]];
      const double twice_area = u.x() * v.y() - u.y() * v.x();
      if (!(twice_area > 0.0)) return 0.0;
      sum += twice_area / (u.squaredNorm() + v.squaredNorm() + w.squaredNorm());
    }
    return sum;
  };
  for_each_visit(mesh, seed, n_sweeps,
                 [&](NodeIndex node, double mean_length, std::uint64_t state) {
                   Point<2> worst = x[node];
                   double worst_quality = std::numeric_limits<double>::infinity();
                   int n_valid = 0;
                   for (int i = 0; i < 20 * n_candidates && n_valid < n_candidates; ++i) {
                     x[node] = original[node] + radius * mean_length * point_of_disc(state);
                     const double quality = quality_around(node);
                     if (!(quality > 0.0)) continue;
                     ++n_valid;
                     if (quality >= worst_quality) continue;
                     worst_quality = quality;
                     worst = x[node];
                   }
                   x[node] = worst;
                 });
  return x;
}

/// Second implementation of random steps of triangles, from the documentation and with other
/// formulas.
inline std::vector<Point<2>> reference_random_steps(const PlanarMesh& mesh, double radius,
                                                    std::uint64_t seed, int n_sweeps) {
  const Topology& topology = mesh.topology();
  std::vector<Point<2>> x = mesh.copied_coordinates();
  const auto all_valid = [&](NodeIndex node) {
    for (const CellIndex cell : topology.node_cells(node)) {
      const auto t = topology.cell_nodes(cell);
      const Point<2> u = x[t[1]] - x[t[0]], v = x[t[2]] - x[t[0]];
      if (!(u.x() * v.y() > u.y() * v.x())) return false;
    }
    return true;
  };
  for_each_visit(
      mesh, seed, n_sweeps, [&](NodeIndex node, double mean_length, std::uint64_t state) {
        Point<2> step = radius * mean_length * point_of_disc(state);
        const Point<2> present = x[node];
        int n_left = 60;
        for (x[node] = present + step; !all_valid(node) && --n_left > 0; x[node] = present + step)
          step *= 0.8;
        if (n_left == 0) x[node] = present;
      });
  return x;
}

}  // namespace smoothfem
