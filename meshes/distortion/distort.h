#pragma once

#include <cstdint>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// How to make a good mesh bad in a way that smoothing can undo.
struct DistortionParameters {
  double target_q_mean = 0.3699;  ///< the published triangle gear; the quad gear has 0.4180
  std::uint64_t seed = 1;
  /// Random places tried for each node. More of them reach a lower quality with smaller radii; with
  /// fewer than about ten the quality of the published meshes is out of reach.
  int n_candidates = 16;
  int n_sweeps = 1;  ///< times all nodes are moved; several make meshes that resist every smoother
  double tolerance = 1e-4;  ///< largest distance of q_mean from the target
};

struct DistortionResult {
  double radius;  ///< of the balls, in units of the mean edge length at the node
  double q_mean;
};

/// Moves the free nodes of a valid mesh at random until its mean quality is the target.
/// Node after node takes, of n_candidates random places in a ball around its original place, the one
/// with the worst mean quality of its cells among those that keep all of them valid (and its present
/// place if there is none). The ball's radius, relative to the mean length of the node's edges in the
/// original mesh, is found by bisection; every radius sees the same random numbers. The result is
/// valid and depends only on mesh and parameters, not on the machine.
/// Throws InputError, with the mesh unchanged, for an invalid mesh, parameters out of range
/// (target in (0, 1), n_candidates and n_sweeps >= 1, tolerance > 0) and a target that no radius
/// reaches, with the range that can be reached.
DistortionResult distort(PlanarMesh& mesh, const DistortionParameters& parameters);

}  // namespace smoothfem
