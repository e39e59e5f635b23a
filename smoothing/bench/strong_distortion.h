// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/tests/volume_meshes.h"

namespace smoothfem::bench {

/// Moves each free node to the worst of `n_candidates` random positions in the ball of radius
/// `radius` around its original position. The worst one has the lowest mean quality of the node's
/// cells among those positions that keep them valid.
inline void distort_strongly(VolumeMesh& mesh, double radius, int n_sweeps, std::uint64_t seed,
                             int n_candidates = 15) {
  const auto original = mesh.copied_coordinates();
  const Topology& topology = mesh.topology();
  test::Random random(seed);
  const auto mean_quality = [&](NodeIndex i) {
    double sum = 0.0;
    for (const CellIndex c : topology.node_cells(i)) {
      const double q = cell_mean_ratio(mesh, c);
      if (!(q > 0.0)) return 2.0;
      sum += q;
    }
    return sum / static_cast<double>(topology.node_cells(i).size());
  };
  for (int sweep = 0; sweep < n_sweeps; ++sweep)
    for (const NodeIndex i : topology.free_nodes()) {
      Point<3> worst_place = mesh.coordinates()[i];
      double worst = mean_quality(i);
      for (int k = 0; k < n_candidates; ++k) {
        Point<3> offset;
        do {
          offset = {random(), random(), random()};
        } while (offset.squaredNorm() > 1.0);
        mesh.coordinates()[i] = original[i] + radius * offset;
        const double quality = mean_quality(i);
        if (quality < worst) {
          worst = quality;
          worst_place = mesh.coordinates()[i];
        }
      }
      mesh.coordinates()[i] = worst_place;
    }
}

}  // namespace smoothfem::bench
