// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Numbers of candidates that reach the mean quality of the thesis' distorted meshes, for dimension
/// 2 or 3.
///
/// Planar: reached at radii of about 1.2; smart Laplace smoothing then behaves as on the published
/// meshes. Fewer candidates do not reach it, and more reach it with smaller movements. Volume: 15
/// do not reach it on coarse tetrahedra. On the flange with seed 1, single cells decide whether the
/// second stage of GETMe, with the thesis' patience, repairs tetrahedra. With 40 candidates it
/// repairs the full mesh and the one with a tenth of the cells. With 20 it fails on the full mesh,
/// with 30 on the small one.
constexpr int default_candidates(int dim) {
  return dim == 2 ? 10 : 40;
}

/// Rule for a node's new position.
enum class DistortionKind {
  /// The worst of several random points around the node's position in the given mesh. Smoothers
  /// that move nodes to the mean of their neighbours undo it easily.
  worst_candidate,
  /// A random step from the present position, shortened until all cells of the node are valid. In
  /// several sweeps nodes move away from the given mesh, together with their neighbours.
  ///
  /// The published distorted gears have this character, compared with their smoothed meshes,
  /// distorted again to the same q_mean. They have more nearly flat cells than the worst candidates
  /// leave, and displacements of neighbours correlate.
  random_steps,
};

/// Names, in the order of DistortionKind.
constexpr std::array<const char*, 2> distortion_kind_names{"worst-candidate", "random-steps"};

/// Parameters for lowering the quality of a good mesh in a way that smoothing can undo.
struct DistortionParameters {
  double target_q_mean = 0.3699;  ///< in (0, 1); the published gear of triangles has this value,
                                  ///< the gear of quadrilaterals 0.4180
  std::uint64_t seed = 1;
  DistortionKind kind = DistortionKind::worst_candidate;
  /// Valid random points for each node, at least 1; not used by random_steps.
  int n_candidates = default_candidates(2);
  int n_sweeps = 1;  ///< number of times that all nodes are moved, at least 1; after several sweeps
                     ///< of worst candidates no smoother recovers the mesh
  /// Smallest mean ratio of a cell, or its own if that is lower; in [0, 1). Without it many steps
  /// would make few cells much worse than in the thesis.
  double min_quality = 0.0;
  double tolerance = 1e-4;  ///< largest distance of q_mean from the target, positive
};

struct DistortionResult {
  double radius;  ///< of the balls, in units of the mean edge length at the node
  double q_mean;
};

/// Moves the free nodes of a valid mesh at random until its mean quality is the target. Node after
/// node moves, n_sweeps times.
///
/// Worst candidate: n_candidates random points in a ball around the node's original position that
/// keep all its cells valid. The node moves to the one with the worst mean quality of these cells.
/// It stays if no such point is found. Random steps: a random vector in a ball, multiplied by .8
/// until all cells are valid; after 60 trials the node stays.
///
/// The ball's radius, relative to the mean length of the node's edges in the original mesh, is
/// found by bisection; every radius uses the same random numbers. Hexahedra also keep a positive
/// Jacobian inside (has_positive_mapping), as finite elements need it. On surface meshes the points
/// in the ball are projected onto the surface or feature line first. The result is valid and
/// depends only on mesh and parameters, not on machine and threads.
///
/// Throws InputError, with the mesh unchanged, for an invalid mesh or parameters out of range
/// (target in (0, 1), n_candidates and n_sweeps >= 1, tolerance > 0). Throws it also for a target
/// that no radius reaches; the message has the range that can be reached.
template <int dim, int spacedim>
DistortionResult distort(Mesh<dim, spacedim>& mesh, const DistortionParameters& parameters);

/// Moves nodes in the same way within balls of a given radius instead of to a target; returns the
/// resulting mean quality. Relative radii of about 0.65 with two sweeps for tetrahedra, and 0.9
/// with one sweep for hexahedra, give the mean quality of the thesis' distorted volume meshes.
template <int dim, int spacedim>
double distort_within(Mesh<dim, spacedim>& mesh, double radius,
                      const DistortionParameters& parameters);

}  // namespace smoothfem
