// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "smoothing/tests/planar_meshes.h"

namespace smoothfem {

/// Returns entries in [-1, 1], the same ones for each seed in every run.
inline Eigen::VectorXd random_vector(Eigen::Index n, std::uint64_t seed) {
  test::Random random(seed);
  Eigen::VectorXd vector(n);
  for (double& entry : vector) entry = random();
  return vector;
}

}  // namespace smoothfem
